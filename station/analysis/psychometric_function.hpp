#pragma once
#include <optional>

#include "station/terms/psychometric.hpp"

namespace turnpoint::analysis {

using terms::Function;
/// Whether a function uses the level itself or its base-10 logarithm (levels must be positive). A Weibull on
/// the linear scale takes its level in dB.
enum class Scale { linear, log10 };

/// Parameters of a psychometric function. The threshold is in the unit of the level. The slope is the
/// exponent of the Weibull (of the amplitude ratio), the standard deviation (spread) of the normal, or 1 /
/// scale of the logistic; on a log10 scale the last two are per decade.
struct Psychometric {
  double threshold = 0, slope = 1, guess = 0, lapse = 0;
};

/// The part between guess and 1 - lapse as a function of a standard variable z: weibull 1 - exp(-exp z),
/// normal Phi(z), logistic 1 / (1 + exp(-z)). The next function is its derivative.
double core(Function function, double z);
double core_derivative(Function function, double z);
double core_inverse(Function function, double p);  ///< p in (0, 1)

/// Position of a level on the axis on which the function has a fixed shape: z = rate(slope) (u -
/// u(threshold)). Throws std::invalid_argument for a level that is not positive on a log10 scale.
double axis_position(Function function, Scale scale, double level);
double level_from_axis(Function function, Scale scale, double u);
double rate_from_slope(Function function, double slope);
double slope_from_rate(Function function, double rate);

/// guess + (1 - guess - lapse) core(z); for the Weibull in dB (Watson 2017)
/// 1 - lapse - (1 - guess - lapse) exp(-10^(slope (x - t) / 20)), on a log10 scale with (x / t)^slope inside.
double probability(Function function, Scale scale, const Psychometric& parameters, double level);

/// The level at which the probability is `p`; empty if p lies outside (guess, 1 - lapse).
std::optional<double> level_at(Function function, Scale scale, const Psychometric& parameters, double p);

}  // namespace turnpoint::analysis

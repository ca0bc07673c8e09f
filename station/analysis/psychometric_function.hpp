#pragma once
#include <optional>

#include "station/terms/psychometric.hpp"

namespace turnpoint::analysis {

using terms::Function;
/// Whether a function works on the level itself or on its base-10 logarithm (levels positive). A Weibull on
/// the linear scale takes its level in dB.
enum class Scale { linear, log10 };

/// Parameters of a psychometric function. Threshold: in the unit of the level. Slope: exponent of the Weibull
/// (of the amplitude ratio), standard deviation (spread) of the normal, 1 / scale of the logistic; on a log10
/// scale the last two per decade.
struct Psychometric {
  double threshold = 0, slope = 1, guess = 0, lapse = 0;
};

/// The part between guess and 1 - lapse as a function of a standard variable z, and its derivative:
/// weibull 1 - exp(-exp z), normal Phi(z), logistic 1 / (1 + exp(-z)).
double core(Function function, double z);
double core_derivative(Function function, double z);
double core_inverse(Function function, double p);  ///< p in (0, 1)

/// The level on the axis where the function is a fixed shape: z = rate(slope) (u - u(threshold)). Throws
/// std::invalid_argument for a level that is not positive on a log10 scale.
double axis_position(Function function, Scale scale, double level);
double level_from_axis(Function function, Scale scale, double u);
double rate_from_slope(Function function, double slope);
double slope_from_rate(Function function, double rate);

/// guess + (1 - guess - lapse) core(z); for the Weibull in dB (Watson 2017)
/// 1 - lapse - (1 - guess - lapse) exp(-10^(slope (x - t) / 20)), on a log10 scale with (x / t)^slope inside.
double probability(Function function, Scale scale, const Psychometric& parameters, double level);

/// The level at which the probability is `p`; none where p lies outside (guess, 1 - lapse).
std::optional<double> level_at(Function function, Scale scale, const Psychometric& parameters, double p);

}  // namespace turnpoint::analysis

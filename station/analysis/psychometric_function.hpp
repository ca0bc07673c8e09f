#pragma once
#include <optional>

#include "station/core/psychometric.hpp"

namespace turnpoint::analysis {

using core::Function;
/// Whether a function of the level uses the level itself or its base-10 logarithm. On the log10 scale, levels
/// must be positive. A Weibull on the linear scale takes its level in dB.
enum class Scale { linear, log10 };

/// Parameters of a psychometric function. The threshold is in the unit of the level. The slope is the
/// Weibull's exponent (of the amplitude ratio), the normal's standard deviation (spread), or the logistic's 1
/// / scale. On a log10 scale, the slopes of normal and logistic are per decade.
struct Psychometric {
  double threshold = 0, slope = 1, guess = 0, lapse = 0;
};

/// The shape of the function, without guess and lapse, as a function of a standard variable z: weibull 1 -
/// exp(-exp z), normal Phi(z), logistic 1 / (1 + exp(-z)). sigmoid_derivative() is its derivative.
double sigmoid(Function function, double z);
double sigmoid_derivative(Function function, double z);
double sigmoid_inverse(Function function, double p);  ///< p must be above 0 and below 1

/// Returns the position u of a level on an axis on which slope and threshold only stretch and shift the
/// function: z = rate(slope) (u - u(threshold)). Throws std::invalid_argument for a level that is not
/// positive on a log10 scale.
double axis_position(Function function, Scale scale, double level);
double level_from_axis(Function function, Scale scale, double u);
double rate_from_slope(Function function, double slope);
double slope_from_rate(Function function, double rate);

/// Returns guess + (1 - guess - lapse) sigmoid(z). For the Weibull in dB (Watson 2017) this is 1 - lapse - (1 -
/// guess - lapse) exp(-10^(slope (x - t) / 20)); on a log10 scale the argument of exp is -(x / t)^slope.
double probability(Function function, Scale scale, const Psychometric& parameters, double level);

/// Returns the level at which the probability is `p`; empty if p lies outside (guess, 1 - lapse).
std::optional<double> level_at(Function function, Scale scale, const Psychometric& parameters, double p);

}  // namespace turnpoint::analysis

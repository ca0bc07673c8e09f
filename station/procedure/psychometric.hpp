#pragma once
#include <optional>

#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

/// Parameters of a psychometric function. The slope is Weibull's exponent (per 20 dB if levels are in dB),
/// the standard deviation of the normal, or 1 / scale of the logistic.
struct Psychometric {
  double threshold = 0, slope = 1, guess = 0, lapse = 0;
};

/// Returns the probability of answer 1 at level x with threshold t. Always finite and in [0, 1].
/// - Weibull with levels in dB, on the linear scale (Watson 2017):
///   1 - lapse - (1 - guess - lapse) exp(-10^(slope (x - t) / 20))
/// - Weibull on a log10 scale, with x and t above 0: 1 - lapse - (1 - guess - lapse) exp(-(x / t)^slope)
/// - normal: guess + (1 - guess - lapse) Phi((x - t) / slope)
/// - logistic: guess + (1 - guess - lapse) / (1 + exp(-slope (x - t)))
/// On a log10 scale, x and t of normal and logistic are the logarithms of level and threshold. The code uses
/// only + - * /, sqrt and the station's own exponential, so the result is the same on every machine.
double probability(Function function, Scale scale, const Psychometric& parameters, double level);

/// Returns the threshold at a value of the second dimension, `from_origin` above its origin, from the
/// threshold at the origin and the gradient per unit of the second dimension:
/// - linear scale: threshold + gradient * from_origin
/// - log10 scale:  threshold * 10^(gradient * from_origin)
/// - dB scale:     threshold * 10^(gradient * from_origin / 20)
/// The result is never below `floor`, if there is one. With levels in dB on the linear scale, this is the
/// contrast sensitivity function of Watson (2017), Example 4.
double threshold_at(Scale scale, double threshold, double gradient, const std::optional<double>& floor,
                    double from_origin);

/// Returns the probability of "yes", between the asymptotes, of an observer who compares a sensation with a
/// criterion: Phi(d' - criterion). d' is 0 at level 0 and 1 at the threshold:
/// - linear scale, levels in dB: d' = 10^(slope (x - t) / 20)
/// - log10 and dB scale:         d' = (x / t)^slope
/// The rate of false alarms is Phi(-criterion). (Lesmes et al. 2015, Frontiers in Psychology 6, 1070, without
/// the saturation of d'.)
double detection_rate(Scale scale, double threshold, double slope, double criterion, double level);

/// Standard normal distribution function; absolute error below 1e-15.
double normal_cdf(double z);

/// Inverse of normal_cdf(), for probabilities between 1e-12 and 1 - 1e-12. Others are moved to these limits.
double normal_quantile(double p);

}  // namespace turnpoint::procedure

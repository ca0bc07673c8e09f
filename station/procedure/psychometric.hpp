#pragma once
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

/// Standard normal distribution function; absolute error below 1e-15.
double normal_cdf(double z);

}  // namespace turnpoint::procedure

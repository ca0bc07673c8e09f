#pragma once
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

/// Parameters of a psychometric function. Slope: Weibull's exponent (per 20 dB where levels are in dB), the
/// standard deviation of the normal, 1/scale of the logistic.
struct Psychometric {
  double threshold = 0, slope = 1, guess = 0, lapse = 0;
};

/// Probability of a 1 at `level`, from + - * / sqrt and own exponentials only (the same on every machine):
///   weibull, levels in dB (linear scale)  1 - lapse - (1 - guess - lapse) exp(-10^(slope (x - t) / 20)),
///   Watson 2017 weibull, log10 scale                  the same with (x / t)^slope inside, x and t positive
///   normal                                guess + (1 - guess - lapse) Phi((x - t) / slope)
///   logistic                              guess + (1 - guess - lapse) / (1 + exp(-slope (x - t)))
/// On a log10 scale normal and logistic take log10 of level and threshold. Always finite, in [0, 1].
double probability(Function function, Scale scale, const Psychometric& parameters, double level);

/// Standard normal distribution function; absolute error below 1e-15.
double normal_cdf(double z);

}  // namespace turnpoint::procedure

#include "station/procedure/psychometric.hpp"

#include <algorithm>
#include <cmath>

#include "station/core/elementary.hpp"

namespace turnpoint::procedure {

namespace {

constexpr double kLn10 = 2.302585092994045684;

/// The exponential function with a limited argument, so that it cannot overflow. Beyond the limit, the
/// psychometric functions are flat.
double saturating_exp(double x) { return core::exp(std::min(x, 700.0)); }

/// (x / t)^slope for levels on a logarithmic scale, 10^(slope (x - t) / 20) for levels in dB.
double strength(Scale scale, double threshold, double slope, double level) {
  if (scale == Scale::linear) return saturating_exp(slope * (level - threshold) * (kLn10 / 20));
  if (level <= 0) return 0;
  return threshold <= 0 ? saturating_exp(700) : saturating_exp(slope * core::log(level / threshold));
}

double sigmoid(Function function, Scale scale, double threshold, double slope, double level) {
  const bool logs = scale != Scale::linear;
  if (logs && (level <= 0 || threshold <= 0)) return level <= 0 ? 0 : 1;
  const double x = logs ? core::log(level / threshold) / kLn10 : level - threshold;
  switch (function) {
    case Function::weibull: {
      const double exponent = logs ? slope * x * kLn10 : slope * x * (kLn10 / 20);
      return 1 - core::exp(-saturating_exp(exponent));
    }
    case Function::normal:
      return normal_cdf(x / slope);
    case Function::logistic:
      return 1 / (1 + saturating_exp(-slope * x));
  }
  return 0;
}

}  // namespace

double normal_cdf(double z) {
  const double a = std::fabs(z);
  if (a > 39) return z < 0 ? 0 : 1;
  const double density = core::exp(-0.5 * a * a) * 0.39894228040143267794;
  double tail = 0;
  if (a < 4) {
    // With density = phi(a): Phi(a) - 1/2 = density (a + a^3/3 + a^5/15 + ...). All terms are positive, so no
    // digits cancel.
    double term = a, sum = a;
    for (int n = 3; term > 1e-18 * sum; n += 2) term *= a * a / n, sum += term;
    tail = 0.5 - density * sum;
  } else {
    // For larger |a| use Laplace's continued fraction for Mills' ratio.
    double ratio = a;
    for (int n = 60; n >= 1; --n) ratio = a + n / ratio;
    tail = density / ratio;
  }
  return z < 0 ? tail : 1 - tail;
}

double normal_quantile(double p) {
  double low = -7.1, high = 7.1;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (normal_cdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double threshold_at(Scale scale, double threshold, double gradient, const std::optional<double>& floor,
                    double from_origin) {
  double at = threshold;
  if (scale == Scale::linear)
    at += gradient * from_origin;
  else  // within these limits neither the threshold nor its ratio to a level overflows
    at *= core::exp(
        std::clamp(gradient * from_origin * (scale == Scale::dB ? kLn10 / 20 : kLn10), -600.0, 600.0));
  return floor ? std::max(*floor, at) : at;
}

double detection_rate(Scale scale, double threshold, double slope, double criterion, double level) {
  return normal_cdf(strength(scale, threshold, slope, level) - criterion);
}

double probability(Function function, Scale scale, const Psychometric& p, double level) {
  const double f = sigmoid(function, scale, p.threshold, p.slope, level);
  return std::clamp(p.guess + (1 - p.guess - p.lapse) * f, 0.0, 1.0);
}

}  // namespace turnpoint::procedure

#include "station/procedure/psychometric.hpp"

#include <algorithm>
#include <cmath>

#include "station/random/elementary.hpp"

namespace turnpoint::procedure {

namespace {

constexpr double kLn10 = 2.302585092994045684;

/// The exponential function with a limited argument, so that it cannot overflow. Beyond the limit, the
/// psychometric functions are flat.
double saturating_exp(double x) { return random::exp(std::min(x, 700.0)); }

double core(Function function, Scale scale, double threshold, double slope, double level) {
  const bool logs = scale != Scale::linear;
  if (logs && (level <= 0 || threshold <= 0)) return level <= 0 ? 0 : 1;
  const double x = logs ? random::log(level / threshold) / kLn10 : level - threshold;
  switch (function) {
    case Function::weibull: {
      const double exponent = logs ? slope * x * kLn10 : slope * x * (kLn10 / 20);
      return 1 - random::exp(-saturating_exp(exponent));
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
  const double density = random::exp(-0.5 * a * a) * 0.39894228040143267794;
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

double probability(Function function, Scale scale, const Psychometric& p, double level) {
  const double f = core(function, scale, p.threshold, p.slope, level);
  return std::clamp(p.guess + (1 - p.guess - p.lapse) * f, 0.0, 1.0);
}

}  // namespace turnpoint::procedure

#include "station/random/elementary.hpp"

#include <cmath>
#include <stdexcept>

namespace turnpoint::random {

namespace {

// ln 2 in two parts. The first part has so few bits that its product with an integer exponent is exact.
constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;

}  // namespace

double log(double x) {
  if (!(x > 0) || !(x <= 1.7976931348623157e308))
    throw std::domain_error("log: the argument must be above 0 and finite");
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // exact, because frexp only changes the exponent
  if (m < 0.70710678118654752) m *= 2, --exponent;
  const double z = (m - 1) / (m + 1), z2 = z * z;  // |z| < 0.1716
  // 2 atanh(z) = 2 z (1 + z^2/3 + z^4/5 + ...); the remainder after 11 terms is 1e-18.
  double sum = 0;
  for (int k = 11; k >= 1; --k) sum = z2 * (1.0 / (2 * k + 1) + sum);
  return exponent * kLn2High + (2 * z + (2 * z * sum + exponent * kLn2Low));
}

double exp(double x) {
  if (!(x <= 709)) throw std::domain_error("exp: the argument must be at most 709");
  if (x < -745) return 0;
  const double n = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = (x - n * kLn2High) - n * kLn2Low;  // |r| < 0.347
  double sum = 1;
  for (int k = 16; k >= 1; --k) sum = 1 + r / k * sum;
  return std::ldexp(sum, static_cast<int>(n));
}

double normal_cdf(double x) {
  if (!(std::fabs(x) < 8)) return x > 0 ? 1 : 0;
  // All terms of the series x + x^3 / 3 + x^5 / (3 5) + ... have the same sign, so no digits cancel
  // (Marsaglia 2004).
  double sum = x, term = x;
  for (int k = 1; std::fabs(term) > 1e-17; ++k) term *= x * x / (2 * k + 1), sum += term;
  return 0.5 + 0.39894228040143267794 * exp(-0.5 * x * x) * sum;
}

}  // namespace turnpoint::random

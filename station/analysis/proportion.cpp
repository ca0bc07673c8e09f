#include "station/analysis/proportion.hpp"

#include <boost/math/special_functions/beta.hpp>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "station/core/number.hpp"

namespace turnpoint::analysis {

namespace {

void check(double successes, int trials, double confidence) {
  if (trials < 1 || successes < 0 || successes > trials)
    throw std::invalid_argument("proportion " + core::number(successes) + " of " + std::to_string(trials) +
                                ": there must be at least one trial, and no more successes than trials");
  if (!(confidence > 0 && confidence < 1))
    throw std::invalid_argument("confidence " + core::number(confidence) +
                                ": it must be above 0 and below 1");
}

}  // namespace

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

double normal_density(double z) {
  return std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
}

double normal_quantile(double p) {
  if (!(p > 0 && p < 1))
    throw std::invalid_argument("normal quantile of " + core::number(p) + ": it must be above 0 and below 1");
  return -std::numbers::sqrt2 * boost::math::erfc_inv(2 * p);
}

Interval wilson(double successes, int trials, double confidence) {
  check(successes, trials, confidence);
  const double n = trials, p = successes / n;
  const double z = normal_quantile(0.5 + confidence / 2), z2 = z * z;
  const double centre = (p + z2 / (2 * n)) / (1 + z2 / n);
  const double half = z / (1 + z2 / n) * std::sqrt(p * (1 - p) / n + z2 / (4 * n * n));
  // With 0 or n successes, one end is exactly 0 or 1. Set it, because rounding could move it outside [0, 1].
  return {successes == 0 ? 0 : centre - half, successes == trials ? 1 : centre + half, confidence};
}

Interval clopper_pearson(double successes, int trials, double confidence) {
  check(successes, trials, confidence);
  const double tail = (1 - confidence) / 2, k = successes, n = trials;
  return {successes == 0 ? 0 : boost::math::ibeta_inv(k, n - k + 1, tail),
          successes == trials ? 1 : boost::math::ibetac_inv(k + 1, n - k, tail), confidence};
}

}  // namespace turnpoint::analysis

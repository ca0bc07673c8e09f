#include "station/core/elementary.hpp"

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "station/core/instruction_sets.hpp"

namespace turnpoint::core {

namespace {

// ln 2 in two parts. The first part has so few bits that its product with an integer exponent is exact.
constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;

constexpr const char* kNoLogarithm = "log: the argument must be above 0 and finite";
constexpr double kSmallestNormal = 2.2250738585072014e-308, kLargest = 1.7976931348623157e308;
/// The bits of the doubles 1/2, 1 and 2^52.
constexpr std::uint64_t kHalf = 0x3fe0000000000000, kOne = 0x3ff0000000000000, kTwo52 = 0x4330000000000000;

bool has_logarithm(double x) { return x > 0 && x <= kLargest; }

/// The logarithm of a positive, finite number. It selects by arithmetic with bits instead of branches, so
/// that compilers vectorise a loop over it.
inline double logarithm(double x) {
  // Multiply a subnormal number by 2^54, which makes it normal.
  const std::uint64_t subnormal = x < kSmallestNormal;
  const auto bits = std::bit_cast<std::uint64_t>(x * std::bit_cast<double>(kOne + (54 * subnormal << 52)));
  // x is m times a power of 2, with m from sqrt(1/2) to sqrt(2).
  const std::uint64_t half = (bits & 0x000fffffffffffffu) | kHalf;
  const std::uint64_t low = std::bit_cast<double>(half) < 0.70710678118654752;
  const double m = std::bit_cast<double>(half + (low << 52));
  // 2^52 plus a small integer has that integer in its low bits. The offset keeps the integer positive.
  const std::uint64_t offset = 1022 + 54 + 1;
  const double exponent =
      std::bit_cast<double>(kTwo52 | ((bits >> 52) + (offset - 1022) - 54 * subnormal - low)) -
      (0x1p52 + offset);
  const double z = (m - 1) / (m + 1), z2 = z * z;  // |z| < 0.1716, so the series below converges fast
  // 2 atanh(z) = 2 z (1 + z^2/3 + z^4/5 + ...); the remainder after 11 terms is 1e-18.
  double sum = 0;
#pragma GCC unroll 11
  for (int k = 11; k >= 1; --k) sum = z2 * (1.0 / (2 * k + 1) + sum);
  return exponent * kLn2High + (2 * z + (2 * z * sum + exponent * kLn2Low));
}

/// Stores the logarithms of `n` numbers. Returns false if a number has no logarithm.
TURNPOINT_CLONES
bool fill_logs(const double* __restrict x, double* __restrict results, std::size_t n) {
  std::uint64_t without = 0;
  for (std::size_t i = 0; i < n; ++i) {
    without |= static_cast<std::uint64_t>(!(x[i] > 0)) | static_cast<std::uint64_t>(!(x[i] <= kLargest));
    results[i] = logarithm(x[i]);
  }
  return without == 0;
}

}  // namespace

double log(double x) {
  if (!has_logarithm(x)) throw std::domain_error(kNoLogarithm);
  return logarithm(x);
}

void logs(std::span<const double> x, std::span<double> results) {
  if (!fill_logs(x.data(), results.data(), x.size())) throw std::domain_error(kNoLogarithm);
}

double exp(double x) {
  if (!(x <= 709)) throw std::domain_error("exp: the argument must be at most 709");
  if (x < -745) return 0;
  const double n = std::floor(x * 1.4426950408889634 + 0.5);
  const double r = (x - n * kLn2High) - n * kLn2Low;  // |r| < 0.347, which is half of ln 2
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

}  // namespace turnpoint::core

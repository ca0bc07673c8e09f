#include "physics/taylor_kernel.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#include "physics/instruction_sets.hpp"

namespace turnpoint::physics {
namespace {

constexpr std::size_t lanes = 16;

}  // namespace

// The last group of points is padded to full size, because a scalar loop over its few points would be slower.
TURNPOINT_CLONES
void horner_real(const TaylorStep& step, const double* x, std::size_t n, double* re) {
  const double inverse = 1 / step.scale;
  for (std::size_t i = 0; i < n; i += lanes) {
    const std::size_t count = n - i < lanes ? n - i : lanes;
    double tau[lanes], sum[lanes];
    for (std::size_t j = 0; j < lanes; ++j) tau[j] = x[i + (j < count ? j : 0)];
    for (std::size_t j = 0; j < lanes; ++j) {
      tau[j] = (step.x_start - tau[j]) * inverse;
      sum[j] = step.re[taylor_order];
    }
    for (int k = taylor_order - 1; k >= 0; --k) {
      for (std::size_t j = 0; j < lanes; ++j) sum[j] = sum[j] * tau[j] + step.re[k];
    }
    for (std::size_t j = 0; j < count; ++j) re[i + j] = sum[j];
  }
}

TURNPOINT_CLONES
void horner_complex(const TaylorStep& step, const double* x, std::size_t n, double* re, double* im) {
  const double inverse = 1 / step.scale;
  for (std::size_t i = 0; i < n; i += lanes) {
    const std::size_t count = n - i < lanes ? n - i : lanes;
    double tau[lanes], a[lanes], b[lanes];
    for (std::size_t j = 0; j < lanes; ++j) tau[j] = x[i + (j < count ? j : 0)];
    for (std::size_t j = 0; j < lanes; ++j) {
      tau[j] = (step.x_start - tau[j]) * inverse;
      a[j] = step.re[taylor_order];
      b[j] = step.im[taylor_order];
    }
    for (int k = taylor_order - 1; k >= 0; --k) {
      for (std::size_t j = 0; j < lanes; ++j) {
        a[j] = a[j] * tau[j] + step.re[k];
        b[j] = b[j] * tau[j] + step.im[k];
      }
    }
    for (std::size_t j = 0; j < count; ++j) {
      re[i + j] = a[j];
      im[i + j] = b[j];
    }
  }
}

TURNPOINT_CLONES
void divide_by_root_width(double half_width, double slope, const double* x, std::size_t n, double* re,
                          double* im) {
  for (std::size_t i = 0; i < n; ++i) {
    const double factor = 1 / std::sqrt(half_width - slope * x[i]);
    re[i] *= factor;
    im[i] *= factor;
  }
}

TURNPOINT_CLONES
void rotate(const double* re, const double* im, std::size_t n, double factor_re, double factor_im,
            double* out) {
  for (std::size_t i = 0; i < n; ++i) {
    const double a = re[i] * factor_re - im[i] * factor_im;
    const double b = re[i] * factor_im + im[i] * factor_re;
    out[2 * i] = a;
    out[2 * i + 1] = b;
  }
}

TURNPOINT_CLONES
bool half_log_square(const double* re, const double* im, std::size_t n, double offset, double* out) {
  // Computes ln(m 2^e) with m in [sqrt(1/2), sqrt 2). ln(m) = 2 atanh((m - 1)/(m + 1)) is computed by its
  // series, and e is read from the exponent bits.
  constexpr double ln2 = 0.693147180559945309417232121458;
  constexpr std::uint64_t sqrt_half = 0x3fe6a09e667f3bcdULL;
  // the bit pattern of about 1e-289; below it, the result is not valid
  constexpr std::uint64_t small = 0x03d0000000000000ULL;
  std::uint64_t any_small = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double square = re[i] * re[i] + im[i] * im[i];
    any_small |= (std::bit_cast<std::uint64_t>(square) - small) >> 63;
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(square) - sqrt_half;
    // `biased` is the exponent plus 2047, a small positive integer. Bit operations convert it to a double,
    // because few instruction sets can convert vectors of 64-bit integers.
    const std::uint64_t biased = (bits + 0x7ff0000000000000ULL) >> 52;
    const double e = std::bit_cast<double>(biased | 0x4330000000000000ULL) - (4503599627370496.0 + 2047.0);
    const std::uint64_t mantissa_bits = (bits & 0x000fffffffffffffULL) + sqrt_half;
    const double m = std::bit_cast<double>(mantissa_bits);
    const double s = (m - 1) / (m + 1);
    const double z = s * s;
    double series = 1.0 / 21;
    series = series * z + 1.0 / 19;
    series = series * z + 1.0 / 17;
    series = series * z + 1.0 / 15;
    series = series * z + 1.0 / 13;
    series = series * z + 1.0 / 11;
    series = series * z + 1.0 / 9;
    series = series * z + 1.0 / 7;
    series = series * z + 1.0 / 5;
    series = series * z + 1.0 / 3;
    out[i] = s * (series * z + 1) + (0.5 * e * ln2 + offset);
  }
  return any_small == 0;
}

TURNPOINT_CLONES
void magnitudes(const double* pairs, std::size_t n, double* out) {
  constexpr std::uint64_t exponent = 0x7ff0000000000000ULL, inverse = 0x7fe0000000000000ULL;
  for (std::size_t i = 0; i < n; ++i) {
    const double sum = std::abs(pairs[2 * i]) + std::abs(pairs[2 * i + 1]);
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(sum) & exponent;
    const double scale = std::bit_cast<double>(inverse - bits);  // 2^-e for a sum of 1 to 2 times 2^e
    const double re = scale * pairs[2 * i], im = scale * pairs[2 * i + 1];
    out[i] = std::sqrt(re * re + im * im) * std::bit_cast<double>(bits);
  }
}

}  // namespace turnpoint::physics

#pragma once
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

namespace turnpoint::audio {

/// Computes the Fourier transform in place (radix 2). The size must be a power of two.
inline void transform(std::vector<std::complex<double>>& a) {
  const std::size_t n = a.size();
  for (std::size_t i = 1, j = 0; i < n; ++i) {
    std::size_t bit = n >> 1;
    for (; j & bit; bit >>= 1) j ^= bit;
    j ^= bit;
    if (i < j) std::swap(a[i], a[j]);
  }
  std::vector<std::complex<double>> roots(n / 2);
  for (std::size_t k = 0; k < n / 2; ++k)
    roots[k] = std::polar(1.0, -2 * M_PI * static_cast<double>(k) / static_cast<double>(n));
  for (std::size_t length = 2; length <= n; length <<= 1)
    for (std::size_t i = 0; i < n; i += length)
      for (std::size_t k = 0; k < length / 2; ++k) {
        const auto u = a[i + k], v = a[i + k + length / 2] * roots[k * (n / length)];
        a[i + k] = u + v;
        a[i + k + length / 2] = u - v;
      }
}

/// Modified Bessel function I_0 by its power series; the Kaiser window needs it.
inline double bessel_i0(double x) {
  double term = 1, sum = 1;
  for (int k = 1; term > sum * 1e-17; ++k) {
    term *= x * x / (4.0 * k * k);
    sum += term;
  }
  return sum;
}

/// Returns the levels of the spectrum's bins 0 ... n/2 in dB re full scale; a tone of amplitude 1 on a bin
/// has 0 dB. The Kaiser window (beta 36) has side lobes below -270 dB and a main lobe of +-12 bins.
inline std::vector<double> levels_dB(const std::vector<double>& samples) {
  constexpr double beta = 36;
  const std::size_t n = samples.size();
  std::vector<std::complex<double>> a(n);
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(n) - 1;
    const double window = bessel_i0(beta * std::sqrt(1 - x * x)) / bessel_i0(beta);
    a[i] = samples[i] * window;
    sum += window;
  }
  transform(a);
  std::vector<double> levels(n / 2 + 1);
  for (std::size_t k = 0; k <= n / 2; ++k) levels[k] = 20 * std::log10(std::abs(a[k]) * 2 / sum + 1e-20);
  return levels;
}

/// Returns the largest level that is more than `guard` bins away from all `bins`.
inline double largest_elsewhere_dB(const std::vector<double>& levels, const std::vector<std::size_t>& bins,
                                   std::size_t guard) {
  double largest = -400;
  for (std::size_t k = 0; k < levels.size(); ++k) {
    bool near = k < guard;
    for (const std::size_t bin : bins) near = near || (k + guard >= bin && k <= bin + guard);
    if (!near) largest = std::max(largest, levels[k]);
  }
  return largest;
}

}  // namespace turnpoint::audio

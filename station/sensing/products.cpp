#include "station/sensing/products.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace turnpoint::sensing {

std::string name(const Product& product) {
  const std::string i = "f" + std::to_string(product.i + 1), j = "f" + std::to_string(product.j + 1);
  switch (product.kind) {
    case ProductKind::half:
      return i + " / 2";
    case ProductKind::third:
      return i + " / 3";
    case ProductKind::second_harmonic:
      return "2 " + i;
    case ProductKind::third_harmonic:
      return "3 " + i;
    case ProductKind::sum:
      return i + " + " + j;
    case ProductKind::difference:
      return i + " - " + j;
    case ProductKind::two_minus_one:
      return "2 " + i + " - " + j;
    case ProductKind::two_plus_one:
      return "2 " + i + " + " + j;
  }
  return "";
}

bool is_odd(ProductKind kind) {
  return kind == ProductKind::third_harmonic || kind == ProductKind::two_minus_one ||
         kind == ProductKind::two_plus_one;
}

std::vector<Product> products_of(std::span<const double> frequencies_Hz, int rate_Hz, double low_Hz,
                                 double apart_Hz) {
  std::vector<Product> made;
  const auto add = [&](ProductKind kind, std::size_t i, std::size_t j, double frequency) {
    const double folded = std::fabs(std::remainder(frequency, rate_Hz));
    if (folded < low_Hz || folded > 0.49 * rate_Hz) return;
    for (const double tone : frequencies_Hz)
      if (std::fabs(tone - folded) < apart_Hz) return;
    for (const Product& other : made)
      if (std::fabs(other.frequency_Hz - folded) < apart_Hz) return;
    made.push_back({kind, static_cast<int>(i), static_cast<int>(j), folded, 0});
  };
  const std::size_t count = frequencies_Hz.size();
  for (std::size_t i = 0; i < count; ++i) {
    const double f = frequencies_Hz[i];
    add(ProductKind::half, i, i, f / 2);
    add(ProductKind::third, i, i, f / 3);
    add(ProductKind::second_harmonic, i, i, 2 * f);
    add(ProductKind::third_harmonic, i, i, 3 * f);
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) {
      if (i == j) continue;
      const double f = frequencies_Hz[i], g = frequencies_Hz[j];
      add(ProductKind::two_minus_one, i, j, 2 * f - g);
      add(ProductKind::two_plus_one, i, j, 2 * f + g);
      if (j < i) continue;
      add(ProductKind::sum, i, j, f + g);
      add(ProductKind::difference, i, j, f - g);
    }
  return made;
}

double amplitude_at(std::span<const double> samples, double frequency_Hz, int rate_Hz) {
  const std::size_t count = samples.size();
  const double turn = 2 * M_PI * frequency_Hz / rate_Hz, bend = 2 * M_PI / static_cast<double>(count);
  // For each sample, e (at the tone's phase) and w (at the window's phase) are rotated by a constant angle.
  // At the start of each chunk they are computed exactly, so that the error stays below 1e-13.
  constexpr std::size_t chunk = 512;
  const std::complex<double> step = std::polar(1.0, turn), window_step = std::polar(1.0, bend);
  double re = 0, im = 0;
  for (std::size_t start = 0; start < count; start += chunk) {
    std::complex<double> e = std::polar(1.0, std::fmod(turn * static_cast<double>(start), 2 * M_PI));
    std::complex<double> w = std::polar(1.0, bend * (static_cast<double>(start) + 0.5));
    for (std::size_t n = start; n < std::min(count, start + chunk); ++n) {
      const double s = samples[n] * (1 - w.real());
      re += s * e.real();
      im += s * e.imag();
      e = {e.real() * step.real() - e.imag() * step.imag(), e.real() * step.imag() + e.imag() * step.real()};
      w = {w.real() * window_step.real() - w.imag() * window_step.imag(),
           w.real() * window_step.imag() + w.imag() * window_step.real()};
    }
  }
  return 2 * std::hypot(re, im) / static_cast<double>(count);
}

}  // namespace turnpoint::sensing

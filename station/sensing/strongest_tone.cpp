#include "station/sensing/strongest_tone.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <unsupported/Eigen/FFT>
#include <vector>

namespace turnpoint::sensing {

namespace {

// A tone in noise is a line that is this many times stronger than the mean of all lines. The strongest of the
// 5000 lines of white noise is 5 times as strong as their mean, rarely 10 times; the high-pass filter raises
// the noise at 48 kHz to 2.7 times the mean.
constexpr double kStandsOut = 30;

}  // namespace

std::optional<FoundTone> strongest_tone(std::span<const double> samples, int rate_Hz, double low_Hz,
                                        double high_Hz) {
  const std::size_t count = samples.size();
  std::vector<double> windowed(std::bit_ceil(count));
  double weights = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const double hann =
        1 - std::cos(2 * std::numbers::pi * (static_cast<double>(n) + 0.5) / static_cast<double>(count));
    windowed[n] = hann * samples[n];
    weights += hann * hann;
  }
  Eigen::FFT<double> fourier;
  std::vector<std::complex<double>> spectrum;
  fourier.fwd(spectrum, windowed);
  // A line is the energy within the main lobe of the window: two bins of the unpadded transform on each side.
  const std::size_t half = spectrum.size() / 2, reach = 2 * spectrum.size() / count;
  const double bin_Hz = rate_Hz / static_cast<double>(spectrum.size());
  const auto bin_of = [&](double frequency_Hz) {
    return static_cast<std::size_t>(
        std::clamp(frequency_Hz / bin_Hz, static_cast<double>(reach), static_cast<double>(half - reach)));
  };
  const std::size_t first = bin_of(low_Hz), end = bin_of(high_Hz);
  const auto energy = [&](std::size_t k) { return std::norm(spectrum[k]); };
  double lobe = 0, total = 0, strongest = 0;
  std::size_t lines = 0, at = first;
  for (std::size_t k = first - reach; k < first + reach; ++k) lobe += energy(k);
  for (std::size_t k = first; k < end; ++k, ++lines) {
    lobe += energy(k + reach);
    if (lobe > strongest) strongest = lobe, at = k;
    total += lobe;
    lobe -= energy(k - reach);
  }
  const double noise = (total - strongest) / static_cast<double>(lines);
  if (lines == 0 || strongest < kStandsOut * noise) return std::nullopt;
  return FoundTone{static_cast<double>(at) * bin_Hz,
                   2 * strongest / (static_cast<double>(spectrum.size()) * weights)};
}

}  // namespace turnpoint::sensing

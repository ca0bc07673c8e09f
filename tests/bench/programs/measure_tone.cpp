// measure_tone FILE RATE CHANNELS CHANNEL: frequency (Hz) and level (dB re full scale, peak) of the strongest
// tone in a raw S32_LE recording, by a windowed scan and a least-squares refinement. Prints "frequency level
// frames".
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

namespace {

std::vector<double> read_channel(const char* path, int channels, int channel) {
  std::ifstream file(path, std::ios::binary);
  std::vector<double> samples;
  std::vector<std::int32_t> frame(static_cast<std::size_t>(channels));
  const auto bytes = static_cast<std::streamsize>(frame.size() * sizeof(std::int32_t));
  while (file.read(reinterpret_cast<char*>(frame.data()), bytes))
    samples.push_back(frame[static_cast<std::size_t>(channel)] / 2147483648.0);
  return samples;
}

/// The loudest stretch of one second, without its ends: silence around a burst says nothing about its tone.
std::vector<double> steady_part(const std::vector<double>& samples, std::size_t length) {
  if (samples.size() <= length) return samples;
  double energy = 0, best = -1;
  std::size_t at = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    energy += samples[i] * samples[i];
    if (i >= length) energy -= samples[i - length] * samples[i - length];
    if (i + 1 >= length && energy > best) best = energy, at = i + 1 - length;
  }
  return {samples.begin() + static_cast<std::ptrdiff_t>(at),
          samples.begin() + static_cast<std::ptrdiff_t>(at + length)};
}

std::complex<double> component(const std::vector<double>& x, double cycles_per_frame) {
  std::complex<double> sum = 0;
  double weights = 0;
  const auto n = static_cast<double>(x.size());
  const auto step = std::polar(1.0, -2 * std::numbers::pi * cycles_per_frame);
  std::complex<double> phasor = 1;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (i % 256 == 0)
      phasor = std::polar(1.0, -2 * std::numbers::pi * cycles_per_frame * static_cast<double>(i));
    const double w = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / n);
    sum += w * x[i] * phasor;
    weights += w;
    phasor *= step;
  }
  return 2.0 * sum / weights;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return std::fprintf(stderr, "measure_tone FILE RATE CHANNELS CHANNEL\n"), 2;
  const double rate = std::atof(argv[2]);
  const auto x = steady_part(read_channel(argv[1], std::atoi(argv[3]), std::atoi(argv[4])),
                             static_cast<std::size_t>(rate / 4));
  if (x.size() < 1000) return std::fprintf(stderr, "measure_tone: too short: %zu frames\n", x.size()), 1;
  // A coarse scan on a short piece, then ever finer around the maximum.
  const std::vector<double> piece(x.begin(), x.begin() +
                                                 2048 * static_cast<std::ptrdiff_t>(x.size() >= 2048) +
                                                 static_cast<std::ptrdiff_t>(x.size() < 2048 ? x.size() : 0));
  double best = 0, at = 0;
  for (int k = 1; k < 2048; ++k) {
    const double f = 0.5 * k / 2048, level = std::abs(component(piece, f));
    if (level > best) best = level, at = f;
  }
  for (double span = 0.5 / 2048; span > 1e-11; span *= 0.6) {
    const double low = std::abs(component(x, at - span)), middle = std::abs(component(x, at)),
                 high = std::abs(component(x, at + span));
    if (low > middle && low > high) at -= span;
    if (high > middle && high > low) at += span;
  }
  std::printf("%.6f %.4f %zu\n", at * rate, 20 * std::log10(std::abs(component(x, at)) + 1e-300), x.size());
}

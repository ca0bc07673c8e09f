// measure_tone FILE RATE CHANNELS CHANNEL: analyses the loudest quarter second of a raw S32_LE recording and
// prints "FREQUENCY LEVEL RESIDUAL": the frequency (Hz) and level (dB peak, re full scale) of the strongest
// tone, and the residual after subtracting the tone (dB re the tone). A gap or jump of a single frame
// increases the residual. Prints "0 -inf 0" if everything is silent.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <span>
#include <vector>

namespace {

using Samples = std::span<const double>;

std::vector<double> read_channel(const char* path, std::size_t channels, std::size_t channel) {
  std::ifstream file(path, std::ios::binary);
  std::vector<double> samples;
  std::vector<std::int32_t> frame(channels);
  const auto bytes = static_cast<std::streamsize>(channels * sizeof(std::int32_t));
  while (file.read(reinterpret_cast<char*>(frame.data()), bytes))
    samples.push_back(frame[channel] / 2147483648.0);
  return samples;
}

/// Returns the loudest part of this length, because the silence around a burst must not be analysed.
Samples loudest(Samples x, std::size_t length) {
  if (x.size() <= length) return x;
  double energy = 0, best = -1;
  std::size_t begin = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    energy += x[i] * x[i] - (i >= length ? x[i - length] * x[i - length] : 0.0);
    if (i + 1 >= length && energy > best) best = energy, begin = i + 1 - length;
  }
  return x.subspan(begin, length);
}

/// Returns the Hann-weighted Fourier component at this frequency (cycles per frame): a complex number with
/// the peak amplitude and phase of the tone.
std::complex<double> component(Samples x, double cycles_per_frame) {
  const double turn = 2 * std::numbers::pi, n = static_cast<double>(x.size());
  const auto step = std::polar(1.0, -turn * cycles_per_frame), window_step = std::polar(1.0, turn / n);
  std::complex<double> sum = 0, phasor = 1, window = 1;
  for (const double sample : x) {
    sum += (0.5 - 0.5 * window.real()) * sample * phasor;
    phasor *= step;
    window *= window_step;
  }
  return 4.0 * sum / n;
}

/// Returns the strongest frequency in cycles per frame: a coarse scan over a short piece, then a fine scan
/// and a golden-section search over the whole recording.
double strongest_frequency(Samples x) {
  const Samples piece = x.first(std::min<std::size_t>(x.size(), 1024));
  double best = 0, at = 0;
  for (int k = 2; k < 1023; ++k)
    if (const double level = std::abs(component(piece, k / 2048.0)); level > best)
      best = level, at = k / 2048.0;
  // The main lobe of the whole recording is far narrower than that of the short piece.
  const double lobe = 1.0 / static_cast<double>(x.size());
  double start = at;
  best = 0;
  for (double f = at - 1.0 / 1024; f < at + 1.0 / 1024; f += lobe)
    if (const double level = std::abs(component(x, f)); level > best) best = level, start = f;
  double low = start - lobe, high = start + lobe;
  const double golden = 1 / std::numbers::phi;
  while (high - low > 1e-12) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (std::abs(component(x, a)) > std::abs(component(x, b))) {
      high = b;
    } else {
      low = a;
    }
  }
  return (low + high) / 2;
}

double residual_rms(Samples x, double cycles_per_frame, std::complex<double> tone) {
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double phase = 2 * std::numbers::pi * cycles_per_frame * static_cast<double>(i) + std::arg(tone);
    const double left = x[i] - std::abs(tone) * std::cos(phase);
    sum += left * left;
  }
  return std::sqrt(sum / static_cast<double>(x.size()));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) return std::fprintf(stderr, "measure_tone FILE RATE CHANNELS CHANNEL\n"), 2;
  const double rate = std::atof(argv[2]);
  const auto all =
      read_channel(argv[1], std::strtoul(argv[3], nullptr, 10), std::strtoul(argv[4], nullptr, 10));
  const Samples x = loudest(all, static_cast<std::size_t>(rate / 4));
  if (x.size() < 1024) return std::fprintf(stderr, "measure_tone: too short: %zu frames\n", x.size()), 1;
  if (std::all_of(x.begin(), x.end(), [](double s) { return s == 0; })) return std::puts("0 -inf 0"), 0;
  const double f = strongest_frequency(x);
  const auto tone = component(x, f);
  const double residual_dB =
      20 * std::log10(residual_rms(x, f, tone) / (std::abs(tone) / std::numbers::sqrt2) + 1e-15);
  std::printf("%.5f %.4f %.1f\n", f * rate, 20 * std::log10(std::abs(tone)), residual_dB);
}

#include "station/sensing/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace turnpoint::sensing {

namespace {

using Amplitude = std::complex<double>;

constexpr double kStep_Hz = 20;
// the window is flat for kFlat_s on both sides of its centre, and then falls to 0 within kFall_s
constexpr double kFlat_s = 0.06, kFall_s = 0.03;
constexpr std::size_t kNoiseEvery = 16;  // noise is measured at every sixteenth frequency

/// Fourier transform at one frequency, in a window around the sample `centre`, with the phase of frame
/// `origin` as reference.
Amplitude transform(std::span<const double> samples, double frequency_Hz, int rate_Hz, std::int64_t centre,
                    std::int64_t origin) {
  const auto flat = std::llround(kFlat_s * rate_Hz), fall = std::llround(kFall_s * rate_Hz);
  const auto first = std::max<std::int64_t>(0, centre - flat - fall);
  const auto end = std::min<std::int64_t>(std::ssize(samples), centre + flat + fall);
  const double turn = 2 * std::numbers::pi * frequency_Hz / rate_Hz;
  Amplitude at =
      std::polar(1.0, -std::fmod(turn * static_cast<double>(first - origin), 2 * std::numbers::pi));
  const Amplitude step = std::polar(1.0, -turn);
  Amplitude sum = 0;
  for (std::int64_t n = first; n < end; ++n) {
    const auto beyond = static_cast<double>(std::abs(n - centre) - flat) / static_cast<double>(fall);
    const double weight = beyond <= 0 ? 1 : 0.5 + 0.5 * std::cos(std::numbers::pi * beyond);
    const double value = weight * samples[static_cast<std::size_t>(n)];
    sum += Amplitude(value * at.real(), value * at.imag());
    at = {at.real() * step.real() - at.imag() * step.imag(),
          at.real() * step.imag() + at.imag() * step.real()};
  }
  return sum;
}

}  // namespace

audio::Burst sweep_burst(const Sweep& sweep, std::int64_t start_frame) {
  constexpr double ramp_s = 0.02;
  audio::Burst burst;
  burst.start_frame = start_frame;
  burst.length_frames = sweep.frames();
  burst.ramp.frames = std::llround(ramp_s * sweep.rate_Hz);
  burst.tones.count = 1;
  burst.tones.tones[0] = {sweep.low_Hz - kSweepMargin_Hz, sweep.amplitude, 0, sweep.channel};
  burst.change_count = 1;
  burst.changes[0] = {0, sweep.frames(), burst.tones};
  burst.changes[0].to.tones[0].frequency_Hz = sweep.high_Hz + kSweepMargin_Hz;
  return burst;
}

SweepResponse sweep_response(const Sweep& sweep, std::span<const double> played,
                             std::span<const double> captured, double delay_frames) {
  const auto quiet = std::llround(kSweepQuiet_s * sweep.rate_Hz);
  const auto whole = std::llround(delay_frames);
  if (std::ssize(captured) < sweep.frames() + 2 * quiet || std::ssize(played) < sweep.frames())
    throw std::logic_error("sensing: the recording of a sweep is too short");
  SweepResponse made;
  double noise_sum = 0;
  std::size_t noise_count = 0;
  const double rise_Hz =
      (sweep.high_Hz - sweep.low_Hz + 2 * kSweepMargin_Hz) / static_cast<double>(sweep.frames());
  for (double f = sweep.low_Hz; f <= sweep.high_Hz + 1e-6; f += kStep_Hz) {
    const auto passes = std::llround((f - sweep.low_Hz + kSweepMargin_Hz) / rise_Hz);
    const auto in = transform(played, f, sweep.rate_Hz, passes, 0);
    const auto at = quiet + whole;
    const auto out = transform(captured, f, sweep.rate_Hz, passes + at, at);
    const double turn =
        2 * std::numbers::pi * f / sweep.rate_Hz * (delay_frames - static_cast<double>(whole));
    if (made.points.size() % kNoiseEvery == 0) {
      noise_sum += std::norm(
          transform(captured.first(static_cast<std::size_t>(quiet)), f, sweep.rate_Hz, quiet / 2, 0) / in);
      ++noise_count;
    }
    made.points.push_back({f, out / in * std::polar(1.0, turn)});
  }
  made.noise = std::sqrt(noise_sum / static_cast<double>(noise_count));
  for (const double sample : captured) made.largest_sample = std::max(made.largest_sample, std::abs(sample));
  return made;
}

}  // namespace turnpoint::sensing

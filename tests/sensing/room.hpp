#pragma once
// A vibrating surface and its capture, computed from textbook formulas. Phases are computed in long double.
// The code shares nothing with the synthesiser or the measurement.
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <functional>
#include <random>
#include <span>
#include <vector>

#include "station/audio/burst.hpp"
#include "station/sensing/capture_block.hpp"
#include "station/sensing/pick_up.hpp"

namespace turnpoint::sensing {

/// A pick-up with a delay and a constant gain and phase.
struct SimplePickUp {
  int channel = 4;
  double gain = 0.5;
  double phase_rad = 0.7;
  double delay_s = 0.0003;

  std::complex<double> response(double frequency_Hz) const {
    return std::polar(gain, phase_rad - 2 * M_PI * frequency_Hz * delay_s);
  }
};

/// Returns the calibration that belongs to `pick_up` for one output channel, with a point every 50 Hz from 20
/// to 48 kHz.
inline PickUp calibrated(const SimplePickUp& pick_up, int drive_channel = 0) {
  Transfer transfer{drive_channel, {}, {}};
  for (double f = 20e3; f <= 48e3; f += 50) {
    transfer.frequency_Hz.push_back(f);
    transfer.response.push_back(pick_up.response(f));
  }
  return {pick_up.channel, {transfer}};
}

/// What happens to the played signal before it is captured: delay, noise, pick-ups and faults.
struct Room {
  int rate_Hz = 192000;
  int channels = 6;
  double delay_frames = 5000.25;
  double noise = 1e-4;
  std::uint64_t seed = 1;
  std::vector<SimplePickUp> pick_ups{SimplePickUp{}};
  // the members from here on are faults
  double drive_gain = 1;  ///< factor by which the vibration is multiplied
  double frequency_factor = 1;
  double late_s = 0;
  double limiter = 1e9;  ///< the samples of the vibration are clipped at this absolute value
  double hum = 0;        ///< amplitude of 50 Hz hum
  /// Added to the captured signal of each pick-up, as a function of the time since the onset (s).
  std::function<double(double)> extra;
  std::function<double(double)> gain_at;
};

/// Returns the sample that a 24-bit converter gives for this value.
inline std::int32_t converted(double value) {
  const double full = 0x1p23;
  return static_cast<std::int32_t>(std::clamp(std::round(value * full), -full, full - 1)) * 256;
}

/// Returns the gain of a burst with raised-cosine ramps at the time t (s) since its start.
inline long double gate(const audio::Burst& burst, int rate_Hz, long double t) {
  // The synthesiser computes the ramp at the middle of each frame.
  const long double at = t * rate_Hz + 0.5L, ramp = static_cast<long double>(burst.ramp.frames),
                    left = static_cast<long double>(burst.length_frames) - at;
  const auto rise = [ramp](long double x) {
    if (x <= 0) return 0.0L;
    return x >= ramp ? 1.0L : (1 - std::cos(3.14159265358979323846264L * x / ramp)) / 2;
  };
  return rise(at) * rise(left);
}

/// Returns captured frames [first, first + count) of a room in which the burst is played.
inline std::vector<std::int32_t> captured(const Room& room, const audio::Burst& burst, std::int64_t first,
                                          std::int64_t count) {
  const auto channels = static_cast<std::size_t>(room.channels);
  std::vector<std::int32_t> samples(static_cast<std::size_t>(count) * channels);
  std::mt19937_64 random(room.seed);
  std::normal_distribution<double> normal(0, 1);
  constexpr long double two_pi = 6.28318530717958647692529L;
  for (std::int64_t n = 0; n < count; ++n)
    for (const SimplePickUp& pick_up : room.pick_ups) {
      const long double played = static_cast<long double>(first + n - burst.start_frame) -
                                 static_cast<long double>(room.delay_frames);
      const long double t = played / room.rate_Hz - static_cast<long double>(room.late_s);
      const long double envelope = gate(burst, room.rate_Hz, t - static_cast<long double>(pick_up.delay_s));
      double value = 0;
      if (envelope > 0) {
        for (int i = 0; i < burst.tones.count; ++i) {
          const audio::Tone& tone = burst.tones.tones[static_cast<std::size_t>(i)];
          const auto f = static_cast<long double>(tone.frequency_Hz) * room.frequency_factor;
          const auto h = pick_up.response(tone.frequency_Hz);
          value += tone.amplitude * std::abs(h) *
                   static_cast<double>(std::sin(two_pi * f * t + tone.phase_rad + std::arg(h)));
        }
        value *= static_cast<double>(envelope) * room.drive_gain;
        if (room.gain_at) value *= room.gain_at(static_cast<double>(t));
      }
      value = std::clamp(value, -room.limiter, room.limiter);
      value += room.noise * normal(random);
      if (room.hum > 0) value += room.hum * static_cast<double>(std::sin(two_pi * 50 * t));
      if (room.extra) value += room.extra(static_cast<double>(t));
      samples[static_cast<std::size_t>(n) * channels + static_cast<std::size_t>(pick_up.channel)] =
          converted(value);
    }
  return samples;
}

/// Calls `take` with the samples in blocks. The block sizes repeat in the given order.
template <class Take>
void in_blocks(const Room& room, std::span<const std::int32_t> samples, std::int64_t first,
               const std::vector<std::int64_t>& sizes, Take&& take) {
  const std::int64_t total = static_cast<std::int64_t>(samples.size()) / room.channels;
  std::size_t k = 0;
  for (std::int64_t at = 0; at < total; ++k) {
    const std::int64_t size = std::min(sizes[k % sizes.size()], total - at);
    take(CaptureBlock{samples.subspan(static_cast<std::size_t>(at * room.channels),
                                      static_cast<std::size_t>(size * room.channels)),
                      room.channels, first + at, room.rate_Hz});
    at += size;
  }
}

}  // namespace turnpoint::sensing

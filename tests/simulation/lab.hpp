#pragma once
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "station/simulation/plant.hpp"

namespace turnpoint::simulation {

using std::numbers::pi;

inline constexpr double kRate_Hz = 192000;
inline constexpr double kCarrier_Hz = 10525;
inline constexpr int kReference = 0, kBridgeA = 1, kBridgeB = 2, kLateral = 3, kMarker = 4, kPickup = 5;

/// An aluminium plate without noise, distortion, crosstalk, zeros or finger. The transducer plays channel 0,
/// and channel 3 is the carrier.
inline Setup quiet_setup() {
  Setup setup;
  setup.surface = physics::aluminium_plate();
  setup.pickups = {{5, 0.003, 0.1, 0}, {6, 0.009, 0.1, 0}};
  setup.cells.crosstalk = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  setup.wires.crosstalk_V_per_full_scale = 0;
  setup.wires.a2_per_V = setup.wires.a3_per_V2 = 0;
  setup.wires.noise_V_per_rtHz = setup.wires.converter_noise_full_scale = 0;
  setup.finger.normal_noise = setup.finger.friction_noise = 0;
  return setup;
}

inline double cosine(double frequency_Hz, std::int64_t frame) {
  return std::cos(2 * pi * std::fmod(frequency_Hz / kRate_Hz * static_cast<double>(frame), 1.0));
}

/// Captured samples. The recording begins at the plant's frame `first`.
struct Recording {
  std::size_t channels;
  std::int64_t first;
  std::vector<double> samples;

  double at(std::int64_t frame, int channel) const {
    return samples[static_cast<std::size_t>(frame - first) * channels + static_cast<std::size_t>(channel)];
  }
  std::int64_t end() const { return first + static_cast<std::int64_t>(samples.size() / channels); }
};

/// Plays the samples `play(frame, channel)` for `frames` frames, in blocks of `block` frames, and returns
/// what was captured.
template <typename Play>
Recording run(Plant& plant, std::int64_t frames, Play play, std::int64_t block = 960) {
  const auto inputs = static_cast<std::size_t>(plant.setup().playback_channels);
  const auto outputs = static_cast<std::size_t>(plant.setup().capture.count);
  Recording recording{outputs, plant.frames(),
                      std::vector<double>(static_cast<std::size_t>(frames) * outputs)};
  std::vector<double> played;
  for (std::int64_t done = 0; done < frames;) {
    const std::int64_t now = std::min(block, frames - done);
    played.clear();
    for (std::int64_t k = 0; k < now; ++k)
      for (std::size_t c = 0; c < inputs; ++c)
        played.push_back(play(recording.first + done + k, static_cast<int>(c)));
    plant.advance(played, std::span(recording.samples)
                              .subspan(static_cast<std::size_t>(done) * outputs,
                                       static_cast<std::size_t>(now) * outputs));
    done += now;
  }
  return recording;
}

inline double silence(std::int64_t, int) { return 0; }
inline double carrier(std::int64_t frame, int channel) {
  return channel == 3 ? cosine(kCarrier_Hz, frame) : 0;
}

/// Returns the complex amplitude z of the tone Re(z exp(2 pi i f frame / rate)) in a channel, measured with a
/// Hann window over the frames [from, to).
inline std::complex<double> amplitude(const Recording& recording, int channel, double frequency_Hz,
                                      std::int64_t from, std::int64_t to) {
  std::complex<double> sum = 0;
  double total = 0;
  for (std::int64_t n = from; n < to; ++n) {
    const double share = (static_cast<double>(n - from) + 0.5) / static_cast<double>(to - from);
    const double window = 1 - std::cos(2 * pi * share);
    const double cycles = std::fmod(frequency_Hz / kRate_Hz * static_cast<double>(n), 1.0);
    sum += window * recording.at(n, channel) * std::polar(1.0, -2 * pi * cycles);
    total += window;
  }
  return 2.0 * sum / total;
}

/// Removes the phase that the loop delay causes. A tone that was played as cosine() then has phase 0.
inline std::complex<double> without_delay(std::complex<double> z, double frequency_Hz, double delay_frames) {
  return z * std::polar(1.0, 2 * pi * std::fmod(frequency_Hz / kRate_Hz * delay_frames, 1.0));
}

}  // namespace turnpoint::simulation

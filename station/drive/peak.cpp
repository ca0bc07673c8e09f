#include "station/drive/peak.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "station/drive/synth.hpp"

namespace turnpoint::drive {
namespace {

// Sum of squares and sum of magnitudes of the impulse response of the noise filters. Both sums run until the
// response has decayed.
struct Response {
  double energy = 0, magnitude = 0;
};

Response impulse_response(const PreparedNoise& noise) {
  Response response;
  double h[2] = {}, l[2] = {};
  double recent = 1;
  for (int n = 0; n < 4'000'000 && recent > 1e-18; ++n) {
    const double x = n == 0 ? 1 : 0;
    const double y = noise.high_pass[0] * x + h[0];
    h[0] = noise.high_pass[1] * x - noise.high_pass[3] * y + h[1];
    h[1] = noise.high_pass[2] * x - noise.high_pass[4] * y;
    const double z = noise.low_pass[0] * y + l[0];
    l[0] = noise.low_pass[1] * y - noise.low_pass[3] * z + l[1];
    l[1] = noise.low_pass[2] * y - noise.low_pass[4] * z;
    response.energy += z * z;
    response.magnitude += std::abs(z);
    recent = std::max(recent * 0.999, std::abs(z));
  }
  return response;
}

using Channels = std::array<double, max_channels>;

Channels sum_of(const std::array<PreparedTone, max_tones>& tones, int count) {
  Channels sum{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    sum[static_cast<std::size_t>(tones[i].channel)] += tones[i].amplitude;
  return sum;
}

// Adds the marker, the noise and the signal to the tones.
Channels with_extras(Channels tones, const PreparedBurst& burst) {
  if (burst.marker.kind != MarkerKind::none)
    tones[static_cast<std::size_t>(burst.marker.channel)] += std::abs(burst.marker.amplitude);
  if (burst.noise.gain > 0)
    tones[static_cast<std::size_t>(burst.noise.channel)] +=
        burst.noise.gain * impulse_response(burst.noise).magnitude;
  if (burst.signal.amplitude > 0)
    tones[static_cast<std::size_t>(burst.signal.channel)] += burst.signal.amplitude;
  return tones;
}

}  // namespace

double noise_rms(const PreparedNoise& noise) { return std::sqrt(impulse_response(noise).energy / 3); }

std::array<double, max_channels> peak_bound(const PreparedBurst& burst) {
  Channels largest = sum_of(burst.tones, burst.tone_count);
  for (std::size_t k = 0; k < static_cast<std::size_t>(burst.change_count); ++k) {
    const Channels sum = sum_of(burst.changes[k].to, burst.changes[k].count);
    for (std::size_t c = 0; c < max_channels; ++c) largest[c] = std::max(largest[c], sum[c]);
  }
  return with_extras(largest, burst);
}

std::array<double, max_channels> peak_bound(const PreparedBurst& burst, const PreparedChange& change) {
  return with_extras(sum_of(change.to, change.count), burst);
}

std::array<double, max_channels> rendered_peak(const PreparedBurst& burst, const Format& format) {
  Synth synth(format);
  PreparedBurst moved = burst;
  moved.start_frame = 0;
  std::array<double, max_channels> peak{};
  if (!synth.start(moved)) return peak;
  const auto channels = static_cast<std::size_t>(format.channels);
  std::vector<double> block(channels * Synth::max_block);
  for (std::int64_t frame = 0; frame < burst.length_frames; frame += Synth::max_block) {
    synth.render(frame, std::span<double>(block));
    for (std::size_t k = 0; k < block.size(); ++k)
      peak[k % channels] = std::max(peak[k % channels], std::abs(block[k]));
  }
  return peak;
}

}  // namespace turnpoint::drive

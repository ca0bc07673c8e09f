#include "station/audio/prepared_burst.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "station/audio/sine.hpp"
#include "station/audio/synth.hpp"
#include "station/audio/trigger_code.hpp"

namespace turnpoint::audio {
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

Channels sum_of(const std::array<Partial, max_tones>& tones, int count) {
  Channels sum{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i)
    sum[static_cast<std::size_t>(tones[i].channel)] += tones[i].amplitude;
  return sum;
}

// Adds the marker, the noise and the signal to the tones. The gain that the tones follow does not act on
// them.
Channels with_extras(Channels tones, const PreparedBurst& burst) {
  if (burst.following.follows())
    for (double& sum : tones) sum *= burst.following.most_gain;
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

Partial rendered(const Tone& tone, int rate_Hz) {
  return {phase_of_angle(tone.phase_rad),
          phase_increment(tone.frequency_Hz, rate_Hz),
          0,
          tone.amplitude,
          0,
          tone.channel};
}

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
  if (burst.following.follows()) {
    const double gain = burst.following.most_gain;
    for (Partial& tone : moved.tones) tone.amplitude *= gain;
    for (PreparedChange& change : moved.changes)
      for (Partial& tone : change.to) tone.amplitude *= gain;
    moved.following = {};
  }
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

namespace {

template <typename... Args>
[[noreturn]] void refuse(fmt::format_string<Args...> text, Args&&... args) {
  throw BurstRefused("burst refused: " + fmt::format(text, std::forward<Args>(args)...));
}

void check_channel(const char* what, int channel, const Format& format) {
  if (channel < 0 || channel >= format.channels)
    refuse("{} on channel {}; the output has only channels 0 to {}", what, channel, format.channels - 1);
}

void check_frequency(const char* what, double frequency_Hz, const Format& format, const SynthLimits& limits) {
  const double highest = limits.highest_relative_Hz * format.rate_Hz;
  if (!(frequency_Hz > 0 && frequency_Hz < highest))
    refuse("{} of {} Hz; the frequency must be above 0 and below {} Hz ({} of the sample rate of {} Hz)",
           what, frequency_Hz, highest, limits.highest_relative_Hz, format.rate_Hz);
}

Partial prepare(const Tone& tone, const Format& format, const SynthLimits& limits) {
  check_channel("tone", tone.channel, format);
  check_frequency("tone", tone.frequency_Hz, format, limits);
  if (!(tone.amplitude >= 0 && std::isfinite(tone.amplitude)))
    refuse("tone of {} Hz with amplitude {}; the amplitude must not be negative", tone.frequency_Hz,
           tone.amplitude);
  if (!std::isfinite(tone.phase_rad))
    refuse("tone of {} Hz with a phase that is not finite", tone.frequency_Hz);
  return rendered(tone, format.rate_Hz);
}

int checked_count(const ToneSet& set) {
  if (set.count < 0 || set.count > max_tones)
    refuse("{} tones; the number of tones must be from 0 to {}", set.count, max_tones);
  return set.count;
}

// Prepares a change of a burst. The first `before_count` elements of `before` are the burst's tones before
// the change.
PreparedChange prepare(const Change& change, const std::array<Partial, max_tones>& before, int before_count,
                       const Format& format, const SynthLimits& limits) {
  PreparedChange out;
  if (change.at_frame < 0 || change.frames < 0)
    refuse("change at frame {} with a length of {} frames; neither number may be negative", change.at_frame,
           change.frames);
  out.at_frame = change.at_frame;
  out.frames = std::max<std::int64_t>(1, change.frames);
  out.count = std::max(before_count, checked_count(change.to));
  for (int i = 0; i < out.count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (i >= change.to.count) {
      out.to[k] = before[k];
      out.to[k].amplitude = 0;
      continue;
    }
    out.to[k] = prepare(change.to.tones[k], format, limits);
    if (i < before_count && out.to[k].channel != before[k].channel)
      refuse("the change moves tone {} from channel {} to {}; a tone must keep its channel", i,
             before[k].channel, out.to[k].channel);
  }
  return out;
}

void prepare_changes(const Burst& burst, const Format& format, const SynthLimits& limits,
                     PreparedBurst& out) {
  if (burst.change_count < 0 || burst.change_count > max_changes)
    refuse("{} changes; the number of changes must be from 0 to {}", burst.change_count, max_changes);
  std::array<Partial, max_tones> before = out.tones;
  std::int64_t free_from = 0;
  for (int c = 0; c < burst.change_count; ++c) {
    const auto k = static_cast<std::size_t>(c);
    const PreparedChange change = prepare(burst.changes[k], before, out.tone_count, format, limits);
    if (change.at_frame < free_from || change.at_frame + change.frames > burst.length_frames)
      refuse(
          "change at frame {} with a length of {} frames; it must lie between frame {} and the burst's end "
          "at frame {}",
          change.at_frame, change.frames, free_from, burst.length_frames);
    for (int i = out.tone_count; i < change.count; ++i) {
      const auto t = static_cast<std::size_t>(i);
      out.tones[t] = change.to[t];
      out.tones[t].amplitude = 0;
    }
    out.tone_count = std::max(out.tone_count, change.count);
    out.changes[k] = change;
    before = change.to;
    free_from = change.at_frame + change.frames;
  }
  out.change_count = burst.change_count;
}

// Prepares the trigger codes. Each code and the silent bits after it must end before the next code begins.
void prepare_codes(const Marker& marker, const Burst& burst, PreparedMarker& out) {
  const std::int64_t code = trigger_bits * marker.frames, quiet = trigger_quiet_bits * marker.frames;
  if (marker.frames % 2 != 0)
    refuse("a bit of a trigger code has {} frames; use an even number", marker.frames);
  std::int64_t free_from = 0;
  for (std::size_t mark = 0; mark <= static_cast<std::size_t>(burst.change_count); ++mark) {
    out.patterns[mark] = trigger_pattern(marker.codes[mark]);
    if (out.patterns[mark] == 0) continue;
    const std::int64_t begin = mark == 0 ? 0 : burst.changes[mark - 1].at_frame;
    if (begin < free_from || begin + code > burst.length_frames)
      refuse(
          "a trigger code at frame {} of {} has no room; a code lasts {} frames, and {} frames must be "
          "silent "
          "between two codes",
          begin, burst.length_frames, code, quiet);
    free_from = begin + code + quiet;
  }
  out.frames = marker.frames / 2;
}

PreparedMarker prepare(const Marker& marker, const Burst& burst, const Format& format,
                       const SynthLimits& limits) {
  PreparedMarker out;
  if (marker.kind == MarkerKind::none) return out;
  check_channel("marker", marker.channel, format);
  if (marker.kind == MarkerKind::tone) check_frequency("marker", marker.frequency_Hz, format, limits);
  if (!(std::abs(marker.amplitude) <= 1) || marker.frames < 1 || marker.frames > burst.length_frames)
    refuse(
        "marker with amplitude {} and length {} frames; allowed are amplitudes from -1 to 1 and lengths from "
        "1 to {} frames",
        marker.amplitude, marker.frames, burst.length_frames);
  out = {marker.kind, marker.channel, marker.amplitude, 0, marker.frames, {}};
  if (marker.kind == MarkerKind::code) prepare_codes(marker, burst, out);
  if (marker.kind == MarkerKind::tone) out.increment = phase_increment(marker.frequency_Hz, format.rate_Hz);
  return out;
}

// Second-order Butterworth low-pass filter by the bilinear transform. It uses only the station's own
// arithmetic functions, so that all machines get the same result.
void low_pass(double frequency_Hz, const Format& format, double (&out)[5]) {
  const std::uint64_t half_angle = phase_increment(frequency_Hz, format.rate_Hz) / 2;
  const double t = sine_of_phase(half_angle) / sine_of_phase(half_angle + quarter_cycle);
  const double scale = 1 / (1 + 1.4142135623730951 * t + t * t);
  const double b = t * t * scale;
  const double section[5] = {b, 2 * b, b, 2 * (t * t - 1) * scale,
                             (1 - 1.4142135623730951 * t + t * t) * scale};
  std::copy_n(section, 5, out);
}

void high_pass(double frequency_Hz, const Format& format, double (&out)[5]) {
  low_pass(frequency_Hz, format, out);
  const double b = (1 - out[3] + out[4]) / 4;  // makes the gain 1 at half the sampling rate
  out[0] = b;
  out[1] = -2 * b;
  out[2] = b;
}

PreparedNoise prepare(const MaskingNoise& noise, const Format& format, const SynthLimits& limits) {
  PreparedNoise out;
  if (noise.rms == 0) return out;
  check_channel("masking noise", noise.channel, format);
  check_frequency("masking noise", noise.low_Hz, format, limits);
  check_frequency("masking noise", noise.high_Hz, format, limits);
  if (!(noise.rms > 0 && noise.rms < 1) || noise.low_Hz >= noise.high_Hz)
    refuse(
        "masking noise of {} rms from {} to {} Hz; the rms must be between 0 and 1, and the first frequency "
        "below the second",
        noise.rms, noise.low_Hz, noise.high_Hz);
  out.channel = noise.channel;
  out.seed = noise.seed * 0xd1342543de82ef95u;
  high_pass(noise.low_Hz, format, out.high_pass);
  low_pass(noise.high_Hz, format, out.low_pass);
  out.gain = noise.rms / noise_rms(out);
  return out;
}

PreparedSignal prepare(const SignalTone& signal, const Burst& burst, const Format& format,
                       const SynthLimits& limits) {
  if (signal.amplitude == 0) return {};
  check_channel("signal", signal.channel, format);
  check_frequency("signal", signal.frequency_Hz, format, limits);
  if (!(signal.amplitude > 0 && signal.amplitude <= 1))
    refuse("signal with amplitude {}; the amplitude must be from 0 to 1", signal.amplitude);
  if (signal.at_frame < 0 || signal.frames < 1 || signal.at_frame + signal.frames > burst.length_frames)
    refuse("signal at frame {} with a length of {} frames; it must lie within the burst's {} frames",
           signal.at_frame, signal.frames, burst.length_frames);
  if (signal.ramp.frames < 0 || signal.ramp.frames > signal.frames / 2)
    refuse("ramps of {} frames in a signal of {} frames; a ramp may take at most half of the signal",
           signal.ramp.frames, signal.frames);
  return {signal.channel,  signal.amplitude, phase_increment(signal.frequency_Hz, format.rate_Hz),
          signal.at_frame, signal.frames,    signal.ramp};
}

Following checked(const Following& following) {
  if (following.most_gain == 0) return following;
  if (!(following.most_gain > 0 && following.most_gain < 1e6 && following.resting_gain >= 0 &&
        following.resting_gain <= following.most_gain))
    refuse("it follows gains up to {} and rests at {}; the resting gain must be from 0 to the largest gain",
           following.most_gain, following.resting_gain);
  if (following.leave_frames < 1 || following.steady_frames < 1 || following.resume_frames < 1)
    refuse("it goes to rest in {} frames, waits for {} and follows again within {}; each must be 1 or more",
           following.leave_frames, following.steady_frames, following.resume_frames);
  return following;
}

void check_shape(const Burst& burst, const SynthLimits& limits) {
  if (burst.start_frame < 0) refuse("start frame {}; it must not be negative", burst.start_frame);
  if (burst.length_frames < 1 || burst.length_frames > limits.longest_frames)
    refuse("length of {} frames; it must be from 1 to {} frames", burst.length_frames, limits.longest_frames);
  if (burst.ramp.frames < 0 || burst.ramp.frames > burst.length_frames / 2)
    refuse("ramps of {} frames in a burst of {} frames; a ramp may take at most half of the burst",
           burst.ramp.frames, burst.length_frames);
}

}  // namespace

double largest_peak(const Format& format, const SynthLimits& limits) {
  return std::min(limits.peak, 1 - std::ldexp(2, 1 - format.bits));
}

PreparedBurst prepare(const Burst& burst, const Format& format, const SynthLimits& limits) {
  check_shape(burst, limits);
  const double largest = largest_peak(format, limits);
  PreparedBurst out;
  out.start_frame = burst.start_frame;
  out.length_frames = burst.length_frames;
  out.ramp = burst.ramp;
  out.following = checked(burst.following);
  out.tone_count = checked_count(burst.tones);
  for (std::size_t i = 0; i < static_cast<std::size_t>(out.tone_count); ++i)
    out.tones[i] = prepare(burst.tones.tones[i], format, limits);
  prepare_changes(burst, format, limits, out);
  out.marker = prepare(burst.marker, burst, format, limits);
  out.noise = prepare(burst.noise, format, limits);
  out.signal = prepare(burst.signal, burst, format, limits);
  out.peak = peak_bound(out);
  const auto above = [&](double peak) { return peak > largest; };
  if (std::any_of(out.peak.begin(), out.peak.end(), above) &&
      burst.length_frames <= limits.longest_rendered_frames)
    out.peak = rendered_peak(out, format);
  for (std::size_t c = 0; c < max_channels; ++c)
    if (above(out.peak[c]))
      refuse("peak of {:.6f} of full scale on channel {}; the limit is {:.6f}", out.peak[c], c, largest);
  return out;
}

PreparedChange prepare_change(const Change& change, PreparedBurst& burst, const Format& format,
                              const SynthLimits& limits) {
  const double largest = largest_peak(format, limits);
  if (burst.following.follows()) refuse("a burst that follows gains keeps its tones");
  PreparedChange out = prepare(change, burst.tones, burst.tone_count, format, limits);
  out.live = true;
  PreparedBurst with = burst;
  for (auto i = static_cast<std::size_t>(burst.tone_count); i < static_cast<std::size_t>(out.count); ++i) {
    with.tones[i] = out.to[i];
    with.tones[i].amplitude = 0;
  }
  with.tone_count = out.count;
  const auto own = peak_bound(with), live = peak_bound(with, out);
  for (std::size_t c = 0; c < max_channels; ++c) {
    with.peak[c] = std::max({burst.peak[c], own[c], live[c]});
    if (with.peak[c] > largest)
      refuse("the change could reach {:.6f} of full scale on channel {}; the limit is {:.6f}", with.peak[c],
             c, largest);
  }
  burst = with;
  return out;
}

}  // namespace turnpoint::audio

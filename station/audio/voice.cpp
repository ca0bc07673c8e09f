#include "station/audio/voice.hpp"

#include <algorithm>

#include "station/audio/burst.hpp"
#include "station/audio/trigger_code.hpp"

namespace turnpoint::audio {
namespace {

// Filters one sample by a second-order section in transposed direct form II.
double section(const double (&c)[5], double (&state)[2], double x) noexcept {
  const double y = c[0] * x + state[0];
  state[0] = c[1] * x - c[3] * y + state[1];
  state[1] = c[2] * x - c[4] * y;
  return y;
}

}  // namespace

void Voice::begin(const PreparedBurst& burst) noexcept {
  burst_ = burst;
  origin_ = 0;
  glide_end_ = never;
  next_change_ = 0;
  live_waits_ = false;
  stop_count_ = 0;
  resume_at_ = -never;
  line_.begin(burst.following);
  high_[0] = high_[1] = low_[0] = low_[1] = 0;
}

void Voice::change(const PreparedChange& change) noexcept {
  live_ = change;
  live_waits_ = true;
}

void Voice::stop(std::int64_t at, const Ramp& ramp) noexcept {
  const Stop stop{at, ramp};
  if (stop_count_ == stops_.size() || stop.end() >= end()) return;
  stops_[stop_count_++] = stop;
}

void Voice::follow(GainPeriod period) noexcept {
  if (!burst_.following.follows()) return;
  period.frame -= burst_.start_frame;
  line_.push(period);
}

void Voice::resume(std::int64_t at) noexcept {
  resume_at_ = at;
  high_[0] = high_[1] = low_[0] = low_[1] = 0;
}

std::int64_t Voice::end() const noexcept {
  return stop_count_ == 0 ? burst_.length_frames : std::max<std::int64_t>(0, stops_[stop_count_ - 1].end());
}

const PreparedChange* Voice::due_change(std::int64_t at) const noexcept {
  if (next_change_ < burst_.change_count) {
    const auto& change = burst_.changes[static_cast<std::size_t>(next_change_)];
    if (change.at_frame <= at) return &change;
  }
  return live_waits_ && live_.at_frame <= at ? &live_ : nullptr;
}

void Voice::begin_glide(std::int64_t at, const PreparedChange& change) noexcept {
  const auto since = static_cast<std::uint64_t>(at - origin_);
  const double along = glide_end_ == never ? 0 : ramp_at(at - origin_, glide_frames_);
  const int count = std::max(burst_.tone_count, change.count);
  glide_frames_ = std::max<std::int64_t>(1, change.frames);
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    target_[k] = change.to[k];
    // A tone that is new in this change gets the phase that it would have if it had run silently since the
    // onset.
    if (i >= burst_.tone_count) {
      burst_.tones[k] = advanced(target_[k], static_cast<std::uint64_t>(origin_));
      burst_.tones[k].amplitude = 0;
    }
    Partial tone = advanced(burst_.tones[k], since);
    tone.amplitude += tone.amplitude_change * along;
    // A tone that the change does not know keeps its frequency: it comes only with a later change, or a live
    // change added it, and it fades out now.
    if (i >= change.count) target_[k] = {0, tone.increment, 0, 0, 0, tone.channel};
    burst_.tones[k] = gliding(tone, target_[k], glide_frames_);
  }
  burst_.tone_count = count;
  origin_ = at;
  glide_end_ = at + glide_frames_;
}

void Voice::end_glide(std::int64_t at) noexcept {
  for (int i = 0; i < burst_.tone_count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    burst_.tones[k] = after_glide(burst_.tones[k], target_[k], at - origin_);
  }
  origin_ = at;
  glide_end_ = never;
}

// Begins and ends all glides that are due at frame `at` or earlier, in order.
void Voice::enter(std::int64_t at) noexcept {
  for (;;) {
    std::int64_t change_at = never;
    if (const PreparedChange* change = due_change(at)) change_at = std::max(change->at_frame, origin_);
    if (glide_end_ <= at && glide_end_ <= change_at) {
      end_glide(glide_end_);
    } else if (change_at != never) {
      const PreparedChange change = *due_change(at);
      if (next_change_ < burst_.change_count &&
          burst_.changes[static_cast<std::size_t>(next_change_)].at_frame <= at)
        ++next_change_;
      else
        live_waits_ = false;
      // A live change that came late begins now, because the frames since its time have already been
      // rendered.
      begin_glide(change.live ? at : change_at, change);
    } else {
      return;
    }
  }
}

std::int64_t Voice::next_boundary(std::int64_t at) const noexcept {
  std::int64_t next = std::min(glide_end_, end());
  if (next_change_ < burst_.change_count)
    next = std::min(next, burst_.changes[static_cast<std::size_t>(next_change_)].at_frame);
  if (live_waits_) next = std::min(next, live_.at_frame);
  return std::max(next, at + 1);
}

void Voice::tones(std::int64_t at, int offset, int count, Scratch& scratch) noexcept {
  const bool gliding = glide_end_ != never;
  double* shape = scratch.shape.data() + offset;
  if (gliding)
    for (int n = 0; n < count; ++n) shape[n] = ramp_at(at + n - origin_, glide_frames_);
  for (int i = 0; i < burst_.tone_count; ++i) {
    const Partial p =
        advanced(burst_.tones[static_cast<std::size_t>(i)], static_cast<std::uint64_t>(at - origin_));
    if (p.amplitude == 0 && p.amplitude_change == 0) continue;
    double* sum = scratch.dry[static_cast<std::size_t>(p.channel)].data() + offset;
    gliding ? add_gliding(sum, count, p, shape) : add_steady(sum, count, p);
  }
}

// Returns the product of the ramps of all stops at frame `at`.
double Voice::stop_gain(std::int64_t at) const noexcept {
  double gain = 1;
  for (std::size_t s = 0; s < stop_count_; ++s)
    if (at >= stops_[s].at) gain *= ramp_at(stops_[s].end() - 1 - at, stops_[s].ramp.frames);
  return gain;
}

// Computes the product of all ramps that overlap these frames. Returns false if no ramp does: the gain is
// then 1.
bool Voice::gains(std::int64_t at, int count, Scratch& scratch) const noexcept {
  const std::int64_t last = at + count, ramp = burst_.ramp.frames, fall = burst_.length_frames - ramp;
  const bool rising = at<ramp, falling = last> fall, stopping = stop_count_ > 0,
             resuming = resume_at_ != -never && at < resume_at_ + ramp;
  if (!(rising || falling || stopping || resuming)) return false;
  for (int n = 0; n < count; ++n) {
    const std::int64_t f = at + n;
    double gain = 1;
    if (f < ramp) gain *= ramp_at(f, ramp);
    if (f >= fall) gain *= ramp_at(burst_.length_frames - 1 - f, ramp);
    gain *= stop_gain(f);
    if (resuming && f < resume_at_ + ramp) gain *= ramp_at(f - resume_at_, ramp);
    scratch.gain[static_cast<std::size_t>(n)] = gain;
  }
  return true;
}

void Voice::markers(std::int64_t at, int first, int last, Mix& mix) const noexcept {
  const PreparedMarker& marker = burst_.marker;
  if (marker.kind == MarkerKind::none) return;
  const auto channel = static_cast<std::size_t>(marker.channel);
  for (int mark = -1; mark < burst_.change_count; ++mark) {
    const std::int64_t begin = mark < 0 ? 0 : burst_.changes[static_cast<std::size_t>(mark)].at_frame;
    const std::uint32_t pattern = marker.patterns[static_cast<std::size_t>(mark + 1)];
    const std::int64_t length = marker.kind != MarkerKind::code ? marker.frames
                                : pattern == 0                  ? 0
                                                                : trigger_half_bits * marker.frames;
    const int from = static_cast<int>(std::clamp<std::int64_t>(begin - at, first, last));
    const int to = static_cast<int>(std::clamp<std::int64_t>(begin + length - at, first, last));
    for (int n = from; n < to; ++n) {
      const std::int64_t since = at + n - begin;
      double wave = 1;
      if (marker.kind == MarkerKind::tone)
        wave = sine_of_phase(marker.increment * static_cast<std::uint64_t>(since));
      else if (marker.kind == MarkerKind::code)
        wave = trigger_wave(pattern, static_cast<int>(since / marker.frames));
      mix.samples[channel][static_cast<std::size_t>(n)] += marker.amplitude * wave;
    }
  }
}

void Voice::signal(std::int64_t at, int first, int last, Mix& mix) const noexcept {
  const PreparedSignal& signal = burst_.signal;
  if (signal.amplitude == 0) return;
  auto& row = mix.samples[static_cast<std::size_t>(signal.channel)];
  const int from = static_cast<int>(std::clamp<std::int64_t>(signal.at_frame - at, first, last));
  const int to =
      static_cast<int>(std::clamp<std::int64_t>(signal.at_frame + signal.frames - at, first, last));
  for (int n = from; n < to; ++n) {
    const std::int64_t since = at + n - signal.at_frame, left = signal.frames - 1 - since;
    double gain = stop_gain(at + n);
    if (since < signal.ramp.frames) gain *= ramp_at(since, signal.ramp.frames);
    if (left < signal.ramp.frames) gain *= ramp_at(left, signal.ramp.frames);
    row[static_cast<std::size_t>(n)] +=
        signal.amplitude * gain * sine_of_phase(signal.increment * static_cast<std::uint64_t>(since));
  }
}

void Voice::noise(std::int64_t at, int first, int last, Mix& mix, const Scratch& scratch,
                  bool gated) noexcept {
  const PreparedNoise& noise = burst_.noise;
  if (noise.gain == 0) return;
  auto& row = mix.samples[static_cast<std::size_t>(noise.channel)];
  for (int n = first; n < last; ++n) {
    const double white = uniform(hashed(noise.seed ^ static_cast<std::uint64_t>(at + n)));
    const double value = section(noise.low_pass, low_, section(noise.high_pass, high_, white));
    const double gain = gated ? scratch.gain[static_cast<std::size_t>(n - first)] : 1;
    row[static_cast<std::size_t>(n)] += noise.gain * gain * value;
  }
}

void Voice::pass(std::int64_t at, int frames) noexcept {
  const std::int64_t last = std::min(end(), at + frames);
  for (std::int64_t n = std::max<std::int64_t>(at, 0); n < last; n = next_boundary(n)) enter(n);
}

void Voice::add(std::int64_t at, Mix& mix, Scratch& scratch) noexcept {
  const int first = static_cast<int>(std::clamp<std::int64_t>(-at, 0, mix.frames));
  const int last = static_cast<int>(std::clamp<std::int64_t>(end() - at, first, mix.frames));
  if (first == last) return;
  std::uint32_t channels = 0;
  for (int i = 0; i < burst_.tone_count; ++i)
    channels |= 1u << burst_.tones[static_cast<std::size_t>(i)].channel;
  for (int i = 0; live_waits_ && i < live_.count; ++i)
    channels |= 1u << live_.to[static_cast<std::size_t>(i)].channel;
  for (std::size_t c = 0; c < max_channels; ++c)
    if (channels >> c & 1) std::fill_n(scratch.dry[c].begin() + first, last - first, 0.0);
  for (int n = first; n < last;) {
    enter(at + n);
    const int count = static_cast<int>(std::min<std::int64_t>(next_boundary(at + n) - (at + n), last - n));
    tones(at + n, n, count, scratch);
    n += count;
  }
  if (burst_.following.follows()) {
    line_.fill(at + first, last - first, scratch.followed.data() + first);
    for (std::size_t c = 0; c < max_channels; ++c)
      for (int n = first; (channels >> c & 1) && n < last; ++n)
        scratch.dry[c][static_cast<std::size_t>(n)] *= scratch.followed[static_cast<std::size_t>(n)];
  }
  const bool gated = gains(at + first, last - first, scratch);
  for (std::size_t c = 0; c < max_channels; ++c) {
    if (!(channels >> c & 1)) continue;
    for (int n = first; n < last; ++n) {
      const auto k = static_cast<std::size_t>(n);
      mix.samples[c][k] +=
          gated ? scratch.dry[c][k] * scratch.gain[k - static_cast<std::size_t>(first)] : scratch.dry[c][k];
      mix.dithered[c][k] = 1;
    }
  }
  noise(at, first, last, mix, scratch, gated);
  markers(at, first, last, mix);
  signal(at, first, last, mix);
}

}  // namespace turnpoint::audio

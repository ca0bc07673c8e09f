#include "station/audio/synth.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "station/audio/voice.hpp"
#include "station/core/usage_error.hpp"
#include "station/system/rights.hpp"

namespace turnpoint::audio {

static_assert(Mix::block == Synth::max_block);

struct Synth::State {
  enum class Phase { unused, waiting, sounding };
  struct Slot {
    Phase phase = Phase::unused;
    Voice voice;
  };

  Format format;
  std::array<Slot, max_voices> slots;
  std::int64_t next_frame = 0;
  Partial carrier;  ///< an amplitude of 0 means that there is no carrier
  Mix mix;
  Scratch scratch;
  std::array<SynthEvent, 8 * max_voices> events;
  std::size_t event_count = 0;
  std::uint64_t saturated = 0;

  void report(SynthEventKind kind, std::uint32_t burst, std::int64_t frame) noexcept {
    if (event_count < events.size()) events[event_count++] = {kind, burst, frame};
  }

  // Frames between the end of the last block and `frame` were lost. Sounding bursts continue with a ramp.
  void skip_to(std::int64_t frame) noexcept {
    for (Slot& slot : slots) {
      if (slot.phase == Phase::unused) continue;
      const std::int64_t start = slot.voice.burst().start_frame;
      if (start < frame) slot.voice.resume(frame - start);
    }
    next_frame = frame;
  }

  bool active() const noexcept {
    return carrier.amplitude != 0 || std::any_of(slots.begin(), slots.end(), [](const Slot& slot) {
             return slot.phase != Phase::unused;
           });
  }

  void mix_block(std::int64_t frame, int frames) noexcept {
    mix.frames = frames;
    for (std::size_t c = 0; c < static_cast<std::size_t>(format.channels); ++c) {
      std::fill_n(mix.samples[c].begin(), frames, 0.0);
      std::fill_n(mix.dithered[c].begin(), frames, std::uint8_t{0});
    }
    if (carrier.amplitude != 0) {
      const auto c = static_cast<std::size_t>(carrier.channel);
      add_steady(mix.samples[c].data(), frames, advanced(carrier, static_cast<std::uint64_t>(frame)));
      std::fill_n(mix.dithered[c].begin(), frames, std::uint8_t{1});
    }
    step(frame, frames, [&](Voice& voice, std::int64_t at) { voice.add(at, mix, scratch); });
  }

  /// Calls `go(voice, at)` for every voice in use, where `at` is `frame` counted from the start of the
  /// voice's burst. Records which bursts began and ended within these frames.
  template <class Go>
  void step(std::int64_t frame, int frames, const Go& go) noexcept {
    if (frame != next_frame) skip_to(frame);
    for (Slot& slot : slots) {
      if (slot.phase == Phase::unused) continue;
      const PreparedBurst& burst = slot.voice.burst();
      const std::int64_t at = frame - burst.start_frame;
      if (slot.phase == Phase::waiting && at + frames > 0) {
        slot.phase = Phase::sounding;
        report(SynthEventKind::started, burst.id, burst.start_frame);
      }
      go(slot.voice, at);
      const auto news = slot.voice.take_news();
      if (news.back) report(SynthEventKind::follows, burst.id, burst.start_frame + *news.back);
      if (news.lost) report(SynthEventKind::unfollowed, burst.id, burst.start_frame + *news.lost);
      if (at + frames >= slot.voice.end()) {
        if (slot.phase == Phase::sounding)
          report(SynthEventKind::ended, burst.id, burst.start_frame + slot.voice.end());
        slot.phase = Phase::unused;
      }
    }
    next_frame = frame + frames;
  }

  void quantise(std::int64_t frame, std::int32_t* out) noexcept {
    const auto channels = static_cast<std::size_t>(format.channels);
    const int shift = 32 - format.bits;
    const double scale = static_cast<double>(std::int64_t{1} << (format.bits - 1));
    for (std::size_t c = 0; c < channels; ++c) {
      for (std::size_t n = 0; n < static_cast<std::size_t>(mix.frames); ++n) {
        std::int32_t& sample = out[n * channels + c];
        double value = mix.samples[c][n] * scale;
        if (mix.dithered[c][n])
          value += triangular(hashed((static_cast<std::uint64_t>(frame) + n) * max_channels + c));
        // Adding 1.5 * 2^52 makes every machine round to the nearest integer in the same way.
        const double rounded = (value + 0x1.8p52) - 0x1.8p52;
        const double held = std::clamp(rounded, -scale, scale - 1);
        saturated += held != rounded ? 1 : 0;
        sample =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(held)) << shift);
      }
    }
  }
};

Synth::Synth(const Format& format) : state_(new State) {
  if (format.rate_Hz < 8000 || format.rate_Hz > 768000 || format.channels < 1 ||
      format.channels > max_channels || format.bits < 8 || format.bits > 32)
    throw core::UsageError(
        fmt::format("stream of {} Hz, {} channels, {} bits; allowed are 8000 to 768000 Hz, 1 to {} channels "
                    "and 8 to 32 bits",
                    format.rate_Hz, format.channels, format.bits, max_channels));
  state_->format = format;
}

Synth::~Synth() = default;

void Synth::set_carrier(const Partial& carrier) noexcept { state_->carrier = carrier; }

bool Synth::start(const PreparedBurst& burst) noexcept {
  if (burst.start_frame < state_->next_frame) {
    state_->report(SynthEventKind::missed, burst.id, burst.start_frame);
    return true;
  }
  for (auto& slot : state_->slots) {
    if (slot.phase != State::Phase::unused) continue;
    slot.voice.begin(burst);
    slot.phase = State::Phase::waiting;
    return true;
  }
  return false;
}

bool Synth::change(std::uint32_t burst, const PreparedChange& change) noexcept {
  for (auto& slot : state_->slots) {
    if (slot.phase == State::Phase::unused || slot.voice.burst().id != burst) continue;
    slot.voice.change(change);
    return true;
  }
  return false;
}

void Synth::follow(const GainPeriod& gains) noexcept {
  for (auto& slot : state_->slots)
    if (slot.phase != State::Phase::unused && slot.voice.burst().id == gains.burst) slot.voice.follow(gains);
}

void Synth::stop(std::uint32_t burst, std::int64_t frame, const Ramp& ramp) noexcept {
  const std::int64_t from = std::max(frame, state_->next_frame);
  for (auto& slot : state_->slots) {
    if (slot.phase == State::Phase::unused) continue;
    const PreparedBurst& held = slot.voice.burst();
    if (burst != 0 && held.id != burst) continue;
    if (held.start_frame < from) {
      slot.voice.stop(from - held.start_frame, ramp);
      continue;
    }
    state_->report(SynthEventKind::ended, held.id, held.start_frame);
    slot.phase = State::Phase::unused;
  }
}

void Synth::render(std::int64_t frame, std::span<std::int32_t> samples) noexcept {
  const auto channels = static_cast<std::size_t>(state_->format.channels);
  const std::size_t total = samples.size() / channels;
  for (std::size_t done = 0; done < total; done += max_block) {
    const auto frames = static_cast<int>(std::min<std::size_t>(max_block, total - done));
    const std::int64_t at = frame + static_cast<std::int64_t>(done);
    if (!state_->active()) {  // most of a session is digital silence, which need not be computed
      std::fill_n(samples.data() + done * channels, static_cast<std::size_t>(frames) * channels, 0);
      state_->next_frame = at + frames;
      continue;
    }
    state_->mix_block(at, frames);
    state_->quantise(at, samples.data() + done * channels);
  }
}

void Synth::render(std::int64_t frame, std::span<double> samples) noexcept {
  const auto channels = static_cast<std::size_t>(state_->format.channels);
  const std::size_t total = samples.size() / channels;
  for (std::size_t done = 0; done < total; done += max_block) {
    const auto frames = static_cast<int>(std::min<std::size_t>(max_block, total - done));
    state_->mix_block(frame + static_cast<std::int64_t>(done), frames);
    for (std::size_t c = 0; c < channels; ++c)
      for (std::size_t n = 0; n < static_cast<std::size_t>(frames); ++n)
        samples[(done + n) * channels + c] = state_->mix.samples[c][n];
  }
}

void Synth::skip_to(std::int64_t frame) noexcept { state_->skip_to(std::max(frame, state_->next_frame)); }

void Synth::pass(std::int64_t frame, std::int64_t frames) noexcept {
  for (std::int64_t done = 0; done < frames; done += max_block) {
    const auto some = static_cast<int>(std::min<std::int64_t>(max_block, frames - done));
    state_->step(frame + done, some, [some](Voice& voice, std::int64_t at) { voice.pass(at, some); });
  }
}

std::span<const SynthEvent> Synth::events() const noexcept {
  return {state_->events.data(), state_->event_count};
}
void Synth::clear_events() noexcept { state_->event_count = 0; }

system::MemoryRange Synth::memory() const noexcept { return system::range_of(*state_); }

std::uint64_t Synth::saturated() const noexcept { return state_->saturated; }

}  // namespace turnpoint::audio

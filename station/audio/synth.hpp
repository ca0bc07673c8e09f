#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "station/audio/gain_line.hpp"
#include "station/audio/oscillator.hpp"
#include "station/audio/prepared_burst.hpp"
#include "station/core/parts.hpp"
#include "station/system/memory_range.hpp"

namespace turnpoint::audio {

/// An event of a burst. Its time is given as a frame of the stream.
enum class SynthEventKind : std::int32_t { started, ended, missed, unfollowed, follows };
struct SynthEvent {
  SynthEventKind kind = SynthEventKind::started;
  std::uint32_t burst = 0;
  /// started: first frame of the burst; ended: first silent frame after it; missed: the requested start,
  /// which was already past; unfollowed: the first frame for which the gains that the burst follows were
  /// missing; follows: the first from which it follows them again
  std::int64_t frame = 0;
};

/// Renders bursts into blocks, in double precision: the same samples on every machine, with spurious products
/// below -290 dB before quantisation. Everything is preallocated: after construction nothing allocates,
/// locks, throws or logs. Use it from one thread at a time. Samples depend only on the absolute frame and the
/// bursts (and the gains that they follow), not on how the stream is divided into blocks. Masking noise is
/// the exception: it has a filter state and is reproduced only by an unbroken stream.
class Synth {
 public:
  static constexpr int max_block = 512;
  /// Bursts that can wait or sound at the same time: the parts of a trial's intervals, and codes of its
  /// events.
  static constexpr int max_voices = core::kMostParts + 4;

  /// Throws core::UsageError for a format outside 8-768 kHz, 1-8 channels or 8-32 bits.
  explicit Synth(const Format& format);
  ~Synth();
  Synth(const Synth&) = delete;
  Synth& operator=(const Synth&) = delete;

  /// Adds a tone without end, whose phase is 0 at frame 0. Call this before the first render().
  void set_carrier(const Partial& carrier) noexcept;
  /// Accepts a burst. Returns false if all voices are in use.
  [[nodiscard]] bool start(const PreparedBurst& burst) noexcept;
  /// Changes a waiting or sounding burst, in addition to the burst's own changes; `at_frame` counts from the
  /// burst's start. A change whose frame is already past begins with the next block. A newer change replaces
  /// an older one that is still waiting, and takes over from a glide in progress. Returns false if the burst
  /// has ended.
  [[nodiscard]] bool change(std::uint32_t burst, const PreparedChange& change) noexcept;
  /// Gives gains to the burst that follows them. Ignored if the burst has ended.
  void follow(const GainPeriod& gains) noexcept;
  /// Ramps a burst (0: all) down from `frame`, or from the next block if `frame` is already past. If a second
  /// stop ends sooner than the first, both ramps are multiplied, so that nothing jumps; if it ends later, it
  /// has no effect. A burst that has not begun by then never begins.
  void stop(std::uint32_t burst, std::int64_t frame, const Ramp& ramp) noexcept;

  /// Writes frames [frame, frame + samples.size() / channels) left-aligned into interleaved `samples`. If
  /// `frame` is not the one at which the last call ended, frames were lost. Bursts then continue, with a
  /// ramp, where they would have been without the loss.
  void render(std::int64_t frame, std::span<std::int32_t> samples) noexcept;
  /// Like the other render(), but writes doubles, without dither and quantisation, for measurements.
  void render(std::int64_t frame, std::span<double> samples) noexcept;
  /// Call this if the last block, or the end of it, was not played. The next block begins at `frame`, which
  /// must not be before the end of the frames already rendered. Bursts that have begun by then continue with
  /// a ramp.
  void skip_to(std::int64_t frame) noexcept;
  /// Advances by this many frames without computing samples. Events and all later samples are the same as
  /// after rendering (except for masking noise).
  void pass(std::int64_t frame, std::int64_t frames) noexcept;

  /// Events since the last call, oldest first. The span is valid until the next render.
  std::span<const SynthEvent> events() const noexcept;
  void clear_events() noexcept;

  /// All memory that render() uses in addition to this object, so that it can be locked.
  system::MemoryRange memory() const noexcept;

  /// number of samples that exceeded the range and were clipped
  std::uint64_t saturated() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace turnpoint::audio

#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "station/drive/oscillator.hpp"
#include "station/drive/prepared_burst.hpp"

namespace turnpoint::drive {

struct MemoryRange;  // rights.hpp

/// What happened to a burst, in frames of the stream.
enum class SynthEventKind : std::int32_t { started, ended, missed };
struct SynthEvent {
  SynthEventKind kind = SynthEventKind::started;
  std::uint32_t burst = 0;
  std::int64_t frame = 0;  ///< first frame, first silent frame, or the frame that was already gone
};

/// Renders bursts into blocks, in double: the same samples on every machine, spurious products below -290 dB
/// before quantisation. Everything is preallocated: after construction nothing allocates, locks, throws or
/// logs. One thread at a time. Samples depend only on the absolute frame and the bursts, not on how the
/// stream is cut into blocks; masking noise alone keeps a filter state and is the same only for an unbroken
/// stream.
class Synth {
 public:
  static constexpr int max_block = 512;
  static constexpr int max_voices = 4;  ///< bursts that may wait or sound at once

  /// Throws terms::UsageError for a format outside 8-768 kHz, 1-8 channels, 8-32 bits.
  explicit Synth(const Format& format, const Kernels& kernels = best_kernels());
  ~Synth();
  Synth(const Synth&) = delete;
  Synth& operator=(const Synth&) = delete;

  /// Takes a burst. False when all voices are taken.
  [[nodiscard]] bool start(const PreparedBurst& burst) noexcept;
  /// Changes a burst that waits or sounds, beside the burst's own changes; `at_frame` counts from the burst's
  /// start. One whose frame is already gone begins with the next block; the newest supersedes one that still
  /// waits, and takes over from a glide in progress. False when the burst is gone.
  [[nodiscard]] bool change(std::uint32_t burst, const PreparedChange& change) noexcept;
  /// Ramps a burst (0: all) down from `frame`, or from the next block where that is gone. A second stop that
  /// ends sooner multiplies with the ramp in progress, so that nothing jumps; one that ends later changes
  /// nothing. Bursts that have not begun by then never do.
  void stop(std::uint32_t burst, std::int64_t frame, const Ramp& ramp) noexcept;

  /// Writes frames [frame, frame + samples.size() / channels) left-aligned into interleaved `samples`. Where
  /// `frame` is not the one that the last call ended at, frames were lost: bursts go on where they would have
  /// been, ramped in.
  void render(std::int64_t frame, std::span<std::int32_t> samples) noexcept;
  /// The same before dither and quantisation, as doubles, for measurement.
  void render(std::int64_t frame, std::span<double> samples) noexcept;
  /// The last block, or its end, was not played: the next one begins at `frame`, which is at or after the end
  /// of what was rendered, and what has begun by then comes back ramped in.
  void skip_to(std::int64_t frame) noexcept;
  /// Goes on by so many frames without computing them: the same events, and the same samples afterwards
  /// (masking noise excepted).
  void pass(std::int64_t frame, std::int64_t frames) noexcept;

  /// Events since the last call, oldest first; valid until the next render.
  std::span<const SynthEvent> events() const noexcept;
  void clear_events() noexcept;

  /// All that render() uses beside this object itself.
  MemoryRange memory() const noexcept;

  bool active() const noexcept;              ///< a burst waits or sounds
  std::uint64_t saturated() const noexcept;  ///< samples that left the range: 0 unless limits were lifted

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace turnpoint::drive

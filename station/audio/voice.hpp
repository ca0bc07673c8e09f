#pragma once
#include <array>
#include <cstdint>
#include <limits>

#include "station/audio/gain_line.hpp"
#include "station/audio/oscillator.hpp"
#include "station/audio/prepared_burst.hpp"

namespace turnpoint::audio {

/// A random number that depends only on the counter, by SplitMix64's finaliser (Steele, Lea, Flood 2014).
/// Dither and noise are therefore the same wherever rendering starts.
inline std::uint64_t hashed(std::uint64_t counter) noexcept {
  std::uint64_t z = counter * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// A random number in (-1, 1) with a triangular distribution of variance 1/6. It is the sum of two
/// independent uniform numbers in (-1/2, 1/2), one from each half of the bits.
inline double triangular(std::uint64_t bits) noexcept {
  const auto high = static_cast<std::int32_t>(bits >> 32), low = static_cast<std::int32_t>(bits);
  return (static_cast<double>(high) + static_cast<double>(low) + 1.0) * 0x1p-32;
}

/// A random number, uniform in (-1, 1).
inline double uniform(std::uint64_t bits) noexcept {
  return (static_cast<double>(static_cast<std::int64_t>(bits) >> 11) + 0.5) * 0x1p-52;
}

inline constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

/// A block during mixing: one row of samples per channel. `dithered` marks the frames of a channel that get
/// dither because they are not digital silence.
struct Mix {
  static constexpr int block = 512;
  int frames = 0;
  alignas(64) std::array<std::array<double, block>, max_channels> samples;
  std::array<std::array<std::uint8_t, block>, max_channels> dithered;
};

/// Working memory that voices share, so that nothing large is on the stack of the audio thread.
struct Scratch {
  alignas(64) std::array<std::array<double, Mix::block>, max_channels> dry;
  alignas(64) std::array<double, Mix::block> gain;
  alignas(64) std::array<double, Mix::block> shape;
  alignas(64) std::array<double, Mix::block> followed;
};

/// A burst in the stream: its state, and the changes and stops requested so far. Frames are counted from the
/// burst's start. No function allocates; all are noexcept.
class Voice {
 public:
  void begin(const PreparedBurst& burst) noexcept;
  /// Accepts a live change (one sent while the burst plays). It replaces an earlier one that still waits.
  void change(const PreparedChange& change) noexcept;
  /// Adds a stop, at which the burst ramps down. Ignored if the burst would not end earlier because of it, or
  /// if there are eight stops already.
  void stop(std::int64_t at, const Ramp& ramp) noexcept;
  /// Call this if frames were lost: from `at` on the sound continues with a ramp.
  void resume(std::int64_t at) noexcept;

  /// Takes gains that the tones follow, in order. Ignored if the burst follows nothing.
  void follow(GainPeriod period) noexcept;

  /// Adds frames [at, at + mix.frames) to the mix. `at` may be negative (the burst has not begun) and must
  /// not decrease.
  void add(std::int64_t at, Mix& mix, Scratch& scratch) noexcept;

  /// Advances by this many frames without computing them. The noise filters keep their state.
  void pass(std::int64_t at, int frames) noexcept;

  GainLine::News take_news() noexcept { return line_.take_news(); }  ///< frames from the burst's start

  std::int64_t end() const noexcept;  ///< the first silent frame after the burst
  const PreparedBurst& burst() const noexcept { return burst_; }

 private:
  void enter(std::int64_t at) noexcept;
  std::int64_t next_boundary(std::int64_t at) const noexcept;
  const PreparedChange* due_change(std::int64_t at) const noexcept;
  void begin_glide(std::int64_t at, const PreparedChange& change) noexcept;
  void end_glide(std::int64_t at) noexcept;
  void tones(std::int64_t at, int offset, int count, Scratch& scratch) noexcept;
  bool gains(std::int64_t at, int count, Scratch& scratch) const noexcept;
  void markers(std::int64_t at, int first, int last, Mix& mix) const noexcept;
  void signal(std::int64_t at, int first, int last, Mix& mix) const noexcept;
  double stop_gain(std::int64_t at) const noexcept;
  void noise(std::int64_t at, int first, int last, Mix& mix, const Scratch& scratch, bool gated) noexcept;

  PreparedBurst burst_;             ///< with its tones as they are rendered now
  std::int64_t origin_ = 0;         ///< frame of the burst at which the frame count n of its tones is 0
  std::int64_t glide_end_ = never;  ///< frame at which the current glide ends
  std::int64_t glide_frames_ = 1;
  std::array<Partial, max_tones> target_;
  int next_change_ = 0;
  bool live_waits_ = false;
  PreparedChange live_;
  struct Stop {
    std::int64_t at = 0;
    Ramp ramp;
    std::int64_t end() const noexcept { return at + ramp.frames; }
  };
  /// stops in effect, each ending sooner than the one before; their gains are multiplied
  std::array<Stop, 8> stops_;
  std::size_t stop_count_ = 0;
  std::int64_t resume_at_ = -never;
  GainLine line_;
  double high_[2] = {}, low_[2] = {};  ///< states of the noise's high-pass and low-pass filter
};

}  // namespace turnpoint::audio

#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include "station/audio/burst.hpp"

namespace turnpoint::audio {

inline constexpr int gains_per_period = 8;

/// Gains of a followed burst for the frames [frame, frame + frames). gain[k] is the gain at frame + (k + 1)
/// frames / 8. Between them, and from the last gain of the period before, the gain is a straight line.
struct GainPeriod {
  std::uint32_t burst = 0;
  std::int32_t frames = 0;  ///< length of the period; a multiple of 8
  std::int64_t frame = 0;   ///< first frame of the period, counted like those of the stream
  std::array<float, gains_per_period> gain{};
};
static_assert(std::is_trivially_copyable_v<GainPeriod>);

/// The gain of a followed burst, frame by frame. As long as the gains come in time, the gain is the line
/// through them, within 0 and the limit. From the first frame whose gain is not there, it goes in a straight
/// line to the resting gain and stays there until gains have come for some time (Following). It never jumps.
/// Before the first period, the gain is the resting gain. Fixed size; nothing allocates, locks or throws.
class GainLine {
 public:
  void begin(const Following& following) noexcept;

  /// Takes the next period, whose `frame` counts from the start of the burst. Periods must come in order, and
  /// at most 32 may be waiting; others are left out, and gains that are not finite are, with their period.
  void push(const GainPeriod& period) noexcept;
  /// Writes the gains of frames [at, at + count); `at` must not decrease.
  void fill(std::int64_t at, int count, double* gain) noexcept;
  /// Since the last call: the frame from which the gain has gone to rest because gains were missing, and the
  /// one from which it has followed them again; empty if it has not.
  struct News {
    std::optional<std::int64_t> lost, back;
  };
  News take_news() noexcept { return std::exchange(news_, {}); }

 private:
  enum class State { following, leaving, resting, resuming };
  static constexpr std::size_t kWaiting = 32;

  bool line_at(std::int64_t frame, double& gain) noexcept;
  double step(std::int64_t frame) noexcept;

  Following following_;
  std::array<GainPeriod, kWaiting> waiting_{};  ///< a ring; the oldest is at first_
  std::size_t first_ = 0, count_ = 0;
  double before_ = 0;           ///< gain at the first frame of the oldest period that is waiting
  std::int64_t end_frame_ = 0;  ///< frame behind the newest period
  double newest_ = 0;           ///< gain there
  bool begun_ = false;          ///< a period has come
  State state_ = State::following;
  std::int64_t since_frame_ = 0;  ///< frame at which the state began
  std::int64_t steady_ = 0;       ///< number of frames in a row whose gain was there
  double gain_ = 0, leave_gain_ = 0;
  News news_;
};

}  // namespace turnpoint::audio

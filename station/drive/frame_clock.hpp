#pragma once
#include <cstdint>
#include <vector>

namespace turnpoint::drive {

/// A straight line through (frame, CLOCK_MONOTONIC) pairs; stored with each trial.
struct ClockFit {
  std::int64_t frame = 0;    ///< reference frame
  std::int64_t time_ns = 0;  ///< when that frame leaves the converter, without its group delay
  double ns_per_frame = 0;
  double residual_ns = 0;  ///< rms of the pairs about the line
  int pairs = 0;

  std::int64_t time_of(std::int64_t at_frame) const noexcept;
  std::int64_t frame_at(std::int64_t at_ns) const noexcept;  ///< nearest frame
  double rate_Hz() const noexcept { return 1e9 / ns_per_frame; }
};

/// Least squares over the newest pairs. Pure: no clock inside.
class FrameClock {
 public:
  /// Throws std::invalid_argument unless the nominal rate is positive and `window` at least 2.
  explicit FrameClock(double nominal_rate_Hz, int window = 1024);

  /// A frame and the time at which it was at the converter; frames must rise. A pair that goes back in frame
  /// or time starts the fit afresh (the device was restarted).
  void add(std::int64_t frame, std::int64_t time_ns);
  void reset();

  /// The line; with fewer than 8 pairs the nominal rate through the newest pair. `pairs` 0 means nothing is
  /// known.
  ClockFit fit() const;

 private:
  struct Pair {
    std::int64_t frame, time_ns;
  };
  double nominal_ns_per_frame_;
  std::size_t window_;
  std::vector<Pair> pairs_;
  std::size_t oldest_ = 0;
};

}  // namespace turnpoint::drive

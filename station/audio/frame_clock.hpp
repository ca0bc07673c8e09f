#pragma once
#include <cstdint>
#include <vector>

namespace turnpoint::audio {

/// A straight line fitted to pairs of a frame number and the time of that frame (CLOCK_MONOTONIC). Each trial
/// stores one.
struct ClockFit {
  std::int64_t frame = 0;  ///< a frame on the fitted line
  /// time at which this frame leaves the converter, without the converter's group delay
  std::int64_t time_ns = 0;
  double ns_per_frame = 0;
  double residual_ns = 0;  ///< root mean square distance of the pairs from the line
  int pairs = 0;

  std::int64_t time_of(std::int64_t at_frame) const noexcept;
  std::int64_t frame_at(std::int64_t at_ns) const noexcept;  ///< the frame that is nearest to this time
  double rate_Hz() const noexcept { return 1e9 / ns_per_frame; }
};

/// Fits a line to the newest pairs of frame and time by least squares. It reads no clock itself.
class FrameClock {
 public:
  /// Throws std::invalid_argument unless the nominal rate is positive and `window` at least 2.
  explicit FrameClock(double nominal_rate_Hz, int window = 1024);

  /// Adds a frame and the time at which it was at the converter; frames must ascend. If a pair goes back in
  /// frame or time, the device was restarted and the fit starts over.
  void add(std::int64_t frame, std::int64_t time_ns);
  void reset();

  /// The fitted line. With fewer than 8 pairs, a line through the newest pair whose slope is the nominal
  /// rate. If `pairs` is 0, the line has no meaning.
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

}  // namespace turnpoint::audio

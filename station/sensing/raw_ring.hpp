#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "station/sensing/capture_block.hpp"

namespace turnpoint::sensing {

/// The value of a sample that was not captured.
inline constexpr std::int32_t kNotCaptured = std::numeric_limits<std::int32_t>::min();

/// Captured frames without a break, as they came from the converter. Samples that were not captured are
/// kNotCaptured; a captured sample of that value is stored as the value next to it.
struct RawCapture {
  std::int64_t first_frame = 0;
  int channels = 1;
  int rate_Hz = 192000;
  std::vector<std::int32_t> samples;  ///< interleaved; full scale is 2^31
};

/// Keeps the newest captured frames, so that somebody can look at what was captured when something went
/// wrong. Taking frames allocates nothing. For an ordinary thread; not thread-safe.
class RawRing {
 public:
  /// Keeps up to `seconds` of all captured channels.
  RawRing(int rate_Hz, int channels, double seconds);

  /// Takes captured frames. Frames that are missing before the block are noted as not captured. A block with
  /// frames that were already taken (after the frames were numbered anew) makes the ring forget the earlier
  /// frames.
  void push(const CaptureBlock& block) noexcept;

  /// Returns the frames that the ring holds, the oldest first.
  RawCapture newest() const;

 private:
  std::int32_t* place_of(std::int64_t frame) noexcept;

  int rate_Hz_, channels_;
  std::int64_t capacity_;  ///< in frames
  std::int64_t begin_ = 0, end_ = 0;
  std::vector<std::int32_t> samples_;  ///< frame n is at index n modulo capacity_
};

}  // namespace turnpoint::sensing

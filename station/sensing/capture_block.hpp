#pragma once
#include <cstdint>
#include <span>

namespace turnpoint::sensing {

/// A block of captured samples: frames in order, the channels of a frame side by side, full scale 2^31 (S32).
/// If the device lost frames, the next block's first_frame jumps.
///
/// Captured and played frames have the same numbers, except for a delay: what is played at frame n is
/// captured at frame n + delay. The code that numbers the blocks may subtract the whole frames of the delay;
/// "delay" then means only the remainder.
struct CaptureBlock {
  std::span<const std::int32_t> samples;  ///< interleaved: frames x channels
  int channels = 1;
  std::int64_t first_frame = 0;
  int rate_Hz = 192000;

  std::int64_t frames() const noexcept { return static_cast<std::int64_t>(samples.size()) / channels; }
};

}  // namespace turnpoint::sensing

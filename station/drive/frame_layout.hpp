#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace turnpoint::drive {

/// How a device wants a sample: 32 bits, or the upper 24 of them in three bytes; both little-endian.
enum class SampleFormat { s32_le, s24_3le };

/// How a device's frames lie in memory. A device may have more channels than the stream.
struct FrameLayout {
  SampleFormat format = SampleFormat::s32_le;
  int channels = 2;

  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(channels) * (format == SampleFormat::s32_le ? 4 : 3);
  }
  /// The depth that the format can carry.
  int bits() const noexcept { return format == SampleFormat::s32_le ? 32 : 24; }
};

/// Packs whole frames of `channels` interleaved samples, left-aligned in 32 bits, as the device wants them.
/// Channels that the stream does not have carry zeros. `out` has room for them; `channels` is at most the
/// layout's.
void pack(std::span<const std::int32_t> samples, int channels, const FrameLayout& layout,
          std::span<unsigned char> out) noexcept;

}  // namespace turnpoint::drive

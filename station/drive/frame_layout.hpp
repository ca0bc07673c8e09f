#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

namespace turnpoint::drive {

/// The sample format of a device, little-endian: all 32 bits of a sample, or its upper 24 bits in three
/// bytes.
enum class SampleFormat { s32_le, s24_3le };

/// How a device arranges a frame in memory. A device may have more channels than the stream.
struct FrameLayout {
  SampleFormat format = SampleFormat::s32_le;
  int channels = 2;

  std::size_t bytes() const noexcept {
    return static_cast<std::size_t>(channels) * (format == SampleFormat::s32_le ? 4 : 3);
  }
  /// The number of bits that the format can carry.
  int bits() const noexcept { return format == SampleFormat::s32_le ? 32 : 24; }
};

/// Packs whole frames of `channels` interleaved samples into the device's layout. The samples are
/// left-aligned in 32 bits. Additional channels of the device carry zeros. `out` must be large enough, and
/// `channels` must not exceed the layout's.
void pack(std::span<const std::int32_t> samples, int channels, const FrameLayout& layout,
          std::span<unsigned char> out) noexcept;

}  // namespace turnpoint::drive

#include "station/drive/frame_layout.hpp"

#include <algorithm>

namespace turnpoint::drive {

void pack(std::span<const std::int32_t> samples, int channels, const FrameLayout& layout,
          std::span<unsigned char> out) noexcept {
  const auto used = static_cast<std::size_t>(channels);
  const int first_bit = 32 - layout.bits();
  auto* at = out.data();
  for (std::size_t frame = 0; frame < samples.size() / used; ++frame) {
    for (std::size_t channel = 0; channel < used; ++channel) {
      const auto sample = static_cast<std::uint32_t>(samples[frame * used + channel]);
      for (int bit = first_bit; bit < 32; bit += 8) *at++ = static_cast<unsigned char>(sample >> bit);
    }
    at = std::fill_n(at, layout.bytes() - used * static_cast<std::size_t>(layout.bits() / 8), '\0');
  }
}

}  // namespace turnpoint::drive

#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "station/audio/ring.hpp"

namespace turnpoint::audio {

/// A Ring for large values. The value that the consumer has used last is overwritten first, so the few slots
/// in use stay in the processor's cache; a Ring goes through all of its memory. Values are written and read
/// in place. Both ends are wait-free.
template <typename T, std::size_t Capacity>
class BlockRing {
  static_assert(Capacity <= 0x10000);

 public:
  BlockRing() {
    for (std::size_t slot = Capacity; slot > 0; --slot)
      spare_[spare_count_++] = static_cast<std::uint16_t>(slot - 1);
  }

  /// Producer only. Calls `write(T& slot)`, which finds an older value in the slot. Returns false and does
  /// nothing if the ring is full.
  template <class Write>
  [[nodiscard]] bool fill(const Write& write) noexcept {
    for (std::uint16_t slot = 0; released_.pop(slot);) spare_[spare_count_++] = slot;
    if (spare_count_ == 0) return false;
    const std::uint16_t slot = spare_[spare_count_ - 1];
    write(slots_[slot]);
    if (!waiting_.push(slot)) return false;  // does not happen: there are as many places as slots
    --spare_count_;
    return true;
  }

  /// Consumer only. Takes the oldest value; null if there is none. It is valid until the next call.
  [[nodiscard]] const T* take() noexcept {
    // There are as many places as slots, so the push succeeds.
    if (taken_ && released_.push(*taken_)) taken_.reset();
    std::uint16_t slot = 0;
    if (!waiting_.pop(slot)) return nullptr;
    taken_ = slot;
    return &slots_[slot];
  }

 private:
  Ring<std::uint16_t, Capacity> waiting_, released_;
  std::array<std::uint16_t, Capacity> spare_{};  ///< slots without a value; used by the producer only
  std::size_t spare_count_ = 0;
  std::optional<std::uint16_t> taken_;  ///< the slot that the consumer uses
  std::array<T, Capacity> slots_{};
};

}  // namespace turnpoint::audio

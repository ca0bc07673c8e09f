#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <type_traits>

namespace turnpoint::audio {

/// Bounded queue from one producer thread to one consumer thread; both ends are wait-free. T is copied and
/// must be trivially copyable. Capacity must be a power of two.
template <typename T, std::size_t Capacity>
class Ring {
  static_assert(std::is_trivially_copyable_v<T>);
  static_assert(Capacity >= 2 && (Capacity & (Capacity - 1)) == 0);

 public:
  /// Producer only. Returns false and does nothing if the ring is full.
  [[nodiscard]] bool push(const T& value) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head - tail_.load(std::memory_order_acquire) == Capacity) return false;
    slots_[head & (Capacity - 1)] = value;
    head_.store(head + 1, std::memory_order_release);
    return true;
  }

  /// Producer only. Returns how many values can certainly be pushed.
  std::size_t room() const noexcept {
    return Capacity - (head_.load(std::memory_order_relaxed) - tail_.load(std::memory_order_acquire));
  }

  /// Consumer only. Returns false and leaves `value` unchanged if the ring is empty.
  [[nodiscard]] bool pop(T& value) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail == head_.load(std::memory_order_acquire)) return false;
    value = slots_[tail & (Capacity - 1)];
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }

 private:
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
  alignas(64) std::array<T, Capacity> slots_{};
};

}  // namespace turnpoint::audio

#pragma once
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace turnpoint::lines {

/// A value that one thread publishes and any thread can read consistently. The writer never waits. A reader
/// that overlaps with a write starts again (a sequence lock whose words are atomics).
template <typename T>
class Published {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  void store(const T& value) noexcept {
    std::array<std::uint64_t, words> raw{};
    std::memcpy(raw.data(), &value, sizeof value);
    const auto version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);
    // A reader that sees one of these words also sees the odd version number, so it knows that a write is in
    // progress and reads again.
    for (std::size_t k = 0; k < words; ++k) words_[k].store(raw[k], std::memory_order_release);
    version_.store(version + 2, std::memory_order_release);
  }

  T load() const noexcept {
    std::array<std::uint64_t, words> raw{};
    for (;;) {
      const auto before = version_.load(std::memory_order_acquire);
      for (std::size_t k = 0; k < words; ++k) raw[k] = words_[k].load(std::memory_order_acquire);
      if (before % 2 == 0 && version_.load(std::memory_order_relaxed) == before) break;
    }
    T value;
    std::memcpy(static_cast<void*>(&value), raw.data(), sizeof value);
    return value;
  }

 private:
  static constexpr std::size_t words = (sizeof(T) + 7) / 8;
  std::atomic<std::uint32_t> version_{0};
  std::array<std::atomic<std::uint64_t>, words> words_{};
};

}  // namespace turnpoint::lines

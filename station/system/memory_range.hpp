#pragma once
#include <cstddef>
#include <vector>

namespace turnpoint::system {

/// A piece of memory that a real-time thread uses.
struct MemoryRange {
  const void* start = nullptr;
  std::size_t length = 0;
};
template <typename T>
MemoryRange range_of(const T& object) noexcept {
  return {&object, sizeof object};
}
template <typename T>
MemoryRange range_of(const std::vector<T>& elements) noexcept {
  return {elements.data(), elements.capacity() * sizeof(T)};
}

}  // namespace turnpoint::system

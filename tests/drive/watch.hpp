#pragma once
#include <cstddef>
#include <vector>

namespace turnpoint::drive {

/// Counts what an audio thread must not do: memory taken or given back, mutexes locked, text written, by the
/// calling thread while it runs `function`. Seen at the C library's door, so alsa-lib's own calls count as
/// well.
void begin_watch() noexcept;
int end_watch() noexcept;

/// Memory that the calling thread took between the two calls and has not given back.
struct Allocation {
  const void* start = nullptr;
  std::size_t size = 0;
};
void begin_record() noexcept;
std::vector<Allocation> end_record();

template <typename Function>
int violations_in(Function&& function) {
  begin_watch();
  function();
  return end_watch();
}

}  // namespace turnpoint::drive

#pragma once
#include <cstddef>
#include <vector>

namespace turnpoint::drive {

/// Counts what an audio thread must not do: allocate or free memory, lock mutexes, write text. Counts calls
/// of the calling thread while it runs `function`. The C library's functions are intercepted, so alsa-lib's
/// calls are included.
void begin_watch() noexcept;
int end_watch() noexcept;

/// Memory that the calling thread allocated between the two calls and has not freed.
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

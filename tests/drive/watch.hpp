#pragma once
#include <cstddef>
#include <vector>

namespace turnpoint::drive {

/// Counts what an audio thread must not do: allocate or free memory, lock mutexes, write text.
/// violations_in() counts such calls of the calling thread while `function` runs. The C library's functions
/// are intercepted, so calls from alsa-lib count as well.
void begin_watch() noexcept;
int end_watch() noexcept;

/// A block of memory that the calling thread allocated between begin_record() and end_record() and has not
/// freed.
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

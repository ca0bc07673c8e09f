#pragma once
#include <cstddef>
#include <vector>

namespace turnpoint::audio {

/// Counts calls that an audio thread must not make: allocating or freeing memory, locking mutexes, writing
/// text. violations_in() counts these calls of the current thread while `function` runs. The functions of the
/// C library are intercepted, so calls from alsa-lib count as well.
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

}  // namespace turnpoint::audio

#pragma once

namespace turnpoint::drive {

/// Counts what an audio thread must not do: memory taken or given back, mutexes locked, text written, by the
/// calling thread while it runs `function`. Seen at the C library's door, so alsa-lib's own calls count as
/// well.
void begin_watch() noexcept;
int end_watch() noexcept;

template <typename Function>
int violations_in(Function&& function) {
  begin_watch();
  function();
  return end_watch();
}

}  // namespace turnpoint::drive

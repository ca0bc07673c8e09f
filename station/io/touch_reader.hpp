#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "station/io/touch_times.hpp"

namespace turnpoint::io {

/// Reported on the reader's thread when the panel was disconnected or is back.
enum class TouchPanelState { lost, back };

/// Reads a touch panel on its own thread (SCHED_FIFO 60 if allowed), in parallel with the toolkit: it opens
/// the device for reading only and does not grab it. Time stamps are the kernel's, from CLOCK_MONOTONIC. If
/// the panel is unplugged, the reader looks for a device of the same name every second.
class TouchReader {
 public:
  using OnState = std::function<void(TouchPanelState)>;

  /// `device` is a path below /dev/input, or the device's name as the kernel reports it. Throws
  /// std::system_error if the device cannot be opened or is not a touch panel; throws core::UsageError if no
  /// device has this name.
  TouchReader(const std::string& device, OnState on_state);
  ~TouchReader();
  TouchReader(const TouchReader&) = delete;
  TouchReader& operator=(const TouchReader&) = delete;

  /// Returns the kernel's time of a touch; see TouchTimes::claim().
  std::optional<std::int64_t> claim(double x, double y, std::int64_t seen_ns) {
    return times_.claim(x, y, seen_ns);
  }

 private:
  class Thread;
  TouchTimes times_;
  std::unique_ptr<Thread> thread_;
};

}  // namespace turnpoint::io

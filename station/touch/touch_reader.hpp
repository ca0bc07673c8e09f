#pragma once
#include <functional>
#include <memory>
#include <string>

#include "station/touch/touch_times.hpp"

namespace turnpoint::touch {

/// What becomes of the panel while it is read; called on the reader's thread.
enum class TouchPanelState { lost, back };

/// Reads a touch panel beside the toolkit, read-only and without grabbing it, on a thread of its own
/// (SCHED_FIFO 60 where allowed), stamped by the kernel with CLOCK_MONOTONIC. A panel that is unplugged is
/// looked for by its name every second until it is back.
class TouchReader {
 public:
  using OnState = std::function<void(TouchPanelState)>;

  /// `device`: a path below /dev/input, or the device's name as the kernel tells it. Throws std::system_error
  /// where it cannot be opened or is no touch panel, terms::UsageError for a name that no device has.
  TouchReader(const std::string& device, OnState on_state);
  ~TouchReader();
  TouchReader(const TouchReader&) = delete;
  TouchReader& operator=(const TouchReader&) = delete;

  /// See TouchTimes::claim().
  std::optional<std::int64_t> claim(double x, double y, std::int64_t seen_ns) {
    return times_.claim(x, y, seen_ns);
  }

 private:
  class Thread;
  TouchTimes times_;
  std::unique_ptr<Thread> thread_;
};

}  // namespace turnpoint::touch

#pragma once
#include <functional>
#include <memory>
#include <string>

#include "station/touch/touch_times.hpp"

namespace turnpoint::touch {

/// State changes of the panel while it is read; reported on the reader's thread.
enum class TouchPanelState { lost, back };

/// Reads a touch panel in parallel to the toolkit, read-only and without grabbing it, on its own thread
/// (SCHED_FIFO 60 if allowed). Stamps are the kernel's, from CLOCK_MONOTONIC. If a panel is unplugged, it is
/// looked for by its name every second until it is back.
class TouchReader {
 public:
  using OnState = std::function<void(TouchPanelState)>;

  /// `device` is a path below /dev/input, or the device's name as the kernel reports it. Throws
  /// std::system_error if it cannot be opened or is not a touch panel, and terms::UsageError for a name that
  /// no device has.
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

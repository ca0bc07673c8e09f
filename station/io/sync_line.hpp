#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "station/io/device_watch.hpp"
#include "station/io/lines.hpp"

namespace turnpoint::io {

/// A line on which another device, such as a scanner, sends pulses. The object has its own thread, which
/// reports each pulse with the kernel's time. Lost edges and a lost chip are reported as faults, as for the
/// buttons.
class SyncLine {
 public:
  /// Called with the time of a pulse's first edge (CLOCK_MONOTONIC), on the thread that watches the line.
  using Pulse = std::function<void(std::int64_t time_ns)>;
  /// If `low` is true, a pulse pulls the line low. Of `handlers`, only `fault` and `back` are called. Throws
  /// the errors of `open`.
  SyncLine(const OpenLines& open, bool low, Pulse pulse, ButtonsHandlers handlers);

 private:
  const Pulse pulse_;
  const ButtonsHandlers handlers_;
  DeviceWatch watch_;
};

/// Opens the line of a URI `gpio:line=NAME,active=low`; null for `sim:`, which sends no pulses. Throws
/// core::UsageError, or LineError.
std::unique_ptr<SyncLine> open_sync_line(const std::string& uri, SyncLine::Pulse pulse,
                                         ButtonsHandlers handlers);

}  // namespace turnpoint::io

#pragma once
#include <memory>

#include "station/drive/amplifier.hpp"
#include "station/panel/lines.hpp"

namespace turnpoint::panel {

/// Which of the lines is what; -1 where there is none.
struct GuardLines {
  int enable = -1;
  int heartbeat = -1;
  int fault = -1;
  int stop = -1;
  bool fault_active_low = false;
  bool stop_active_low = false;
};

/// An amplifier on lines (kernel or simulated) with its guard thread, SCHED_FIFO 75 where that is granted.
/// The enable line is low on return and after destruction. Lines whose chip has gone are a latched fault, and
/// are looked for until they are back; then an operator can clear and arm. Throws what `open` throws at the
/// start.
std::unique_ptr<drive::Amplifier> guard_amplifier(OpenLines open, const GuardLines& roles);

}  // namespace turnpoint::panel

#pragma once
#include <functional>
#include <memory>

#include "station/drive/amplifier.hpp"
#include "station/lines/guard.hpp"
#include "station/lines/lines.hpp"

namespace turnpoint::lines {

/// Which of the lines is what; -1 where there is none.
struct GuardLines {
  int enable = -1;
  int heartbeat = -1;
  int fault = -1;
  int stop = -1;
  bool fault_active_low = false;
  bool stop_active_low = false;
  bool read_back = true;  ///< compare the enable line's level with what was driven, where the chip can tell
};

struct GuardOptions {
  Guard::Config config;
  /// Called on the caller's thread between the steps of each call, never on the guard's: a test stalls the
  /// caller there.
  std::function<void()> scheduler_point;
};

/// An amplifier on lines (kernel or simulated) with its guard thread, SCHED_FIFO 75 where that is granted.
/// Once the lines are open only that thread uses them. It takes the edges of fault and stop, and also reads
/// their levels: every 0.5 ms while the enable line is high, in every beat, and before each arming and
/// enabling. So an edge that is lost, or that the kernel hands on late, does not matter. The enable line is
/// low on return and after destruction. Lines whose chip has gone are a latched fault, and are looked for
/// until they are back; then an operator can clear and arm. Throws what `open` throws at the start.
std::unique_ptr<drive::Amplifier> guard_amplifier(OpenLines open, const GuardLines& roles,
                                                  GuardOptions options = {});

}  // namespace turnpoint::lines

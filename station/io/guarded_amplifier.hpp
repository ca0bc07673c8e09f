#pragma once
#include <functional>
#include <memory>

#include "station/audio/amplifier.hpp"
#include "station/io/guard.hpp"
#include "station/io/lines.hpp"

namespace turnpoint::io {

/// The index of each line among the requests; -1 if the amplifier does not have the line.
struct GuardLines {
  int enable = -1;
  int heartbeat = -1;
  int fault = -1;
  int stop = -1;
  int gate = -1;  ///< input that reads the gate behind the external monitor; high while it is open
  bool fault_active_low = false;
  bool stop_active_low = false;
  /// compare the actual level of the enable line with the level that was set; used only if the chip can read
  /// its outputs
  bool read_back = true;
};

struct GuardOptions {
  Guard::Config config;
  /// For tests: called between the steps in which a command (arm, enable, trip, ...) is passed to the guard,
  /// on the thread that gives the command. A test can stall that thread there.
  std::function<void()> scheduler_point;
};

/// Makes an amplifier on lines (kernel or simulated) with its guard thread, at SCHED_FIFO 75 if granted. Once
/// the lines are open, only the guard thread uses them. It handles the edges of the fault and stop lines and
/// also reads their levels: every 0.5 ms while the enable line is high, at every toggle of the heartbeat, and
/// before each arming and enabling. A lost or delayed edge therefore does not matter. The enable line is low
/// when this function returns, and after destruction. The loss of the lines' chip is a latched fault. The
/// guard looks for the lines until they are back; then an operator can clear the fault and arm. Throws what
/// `open` throws at the first attempt.
std::unique_ptr<audio::Amplifier> guard_amplifier(OpenLines open, const GuardLines& roles,
                                                  GuardOptions options = {});

}  // namespace turnpoint::io

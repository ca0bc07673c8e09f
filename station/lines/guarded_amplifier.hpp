#pragma once
#include <functional>
#include <memory>

#include "station/drive/amplifier.hpp"
#include "station/lines/guard.hpp"
#include "station/lines/lines.hpp"

namespace turnpoint::lines {

/// The index of each line among the requests; -1 if the amplifier does not have the line.
struct GuardLines {
  int enable = -1;
  int heartbeat = -1;
  int fault = -1;
  int stop = -1;
  bool fault_active_low = false;
  bool stop_active_low = false;
  /// compare the actual level of the enable line with the level that was set, if the chip can read it
  bool read_back = true;
};

struct GuardOptions {
  Guard::Config config;
  /// Called on the caller's thread between the steps of each call, never on the guard's thread, so that a
  /// test can stall the caller there.
  std::function<void()> scheduler_point;
};

/// An amplifier on lines (kernel or simulated) with its guard thread, at SCHED_FIFO 75 if granted. Once the
/// lines are open, only that thread uses them. It handles the edges of fault and stop, and also reads their
/// levels: every 0.5 ms while the enable line is high, in every beat, and before each arming and enabling. So
/// a lost or delayed edge does not matter. The enable line is low on return and after destruction. If the
/// chip of the lines is lost, that is a latched fault; the guard looks for the lines until they are back, and
/// then an operator can clear and arm. Throws what `open` throws at the start.
std::unique_ptr<drive::Amplifier> guard_amplifier(OpenLines open, const GuardLines& roles,
                                                  GuardOptions options = {});

}  // namespace turnpoint::lines

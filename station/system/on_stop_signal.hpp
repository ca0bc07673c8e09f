#pragma once
#include <functional>
#include <string>
#include <thread>

#include "station/system/stop_signals.hpp"

namespace turnpoint::system {

/// While this object exists, the first stop signal calls `act` on another thread instead of ending the
/// program. A second one kills the program (see StopSignals).
class OnStopSignal {
 public:
  explicit OnStopSignal(std::function<void(const std::string& signal)> act);
  OnStopSignal(const OnStopSignal&) = delete;
  OnStopSignal& operator=(const OnStopSignal&) = delete;
  ~OnStopSignal() { signals_.release(); }

 private:
  StopSignals signals_;
  // The last member, so that the thread is joined before the objects that it uses are destroyed.
  std::jthread waiter_;
};

}  // namespace turnpoint::system

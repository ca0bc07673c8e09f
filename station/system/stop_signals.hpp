#pragma once
#include <signal.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "station/core/file_descriptor.hpp"

namespace turnpoint::system {

/// Catches the signals that ask the program to end: SIGTERM (from the service manager, also at shutdown),
/// SIGINT and SIGHUP. Before take_over(), each of them kills the process at once, as by default. After
/// take_over(), the first signal is only recorded, so that the program can shut down cleanly. The program
/// learns of the signal from wait(), descriptor() or told(). A second signal of the same kind kills the
/// process.
///
/// Only one object may exist at a time, because the signal handler finds its eventfd in a global variable.
/// The handler only records the signal and writes to the eventfd.
class StopSignals {
 public:
  /// Throws std::system_error if no descriptor can be created.
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();  ///< restores the signal handlers that were set before take_over()

  /// Records the first signal from now on. Call this before starting anything that must be ended cleanly.
  /// Further calls have no effect. A signal that the process ignores (nohup) stays ignored.
  void take_over();

  /// Returns a descriptor that becomes readable at the first signal and stays so. Do not read from it.
  int descriptor() const { return wake_.get(); }

  /// Waits for the first signal and returns its name ("SIGTERM"). If release() was called before a signal
  /// came, returns "". May be called on any thread.
  std::string wait() const;
  void release();

  /// Returns the first signal's name; "" if there was none.
  static std::string told();
  /// Returns the exit status of a program that the first signal has ended in the middle of its work, as a
  /// shell reports it: 128 and the signal's number; 0 if there was no signal.
  static int exit_status();

 private:
  struct Before {
    int signal = 0;
    struct sigaction action {};
  };
  core::FileDescriptor wake_;  ///< an eventfd
  std::vector<Before> before_;
};

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

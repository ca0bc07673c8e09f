#pragma once
#include <signal.h>

#include <string>
#include <vector>

#include "station/system/file_descriptor.hpp"

namespace turnpoint::system {

/// The signals that ask the program to end: SIGTERM (from the service manager, also at shutdown), SIGINT and
/// SIGHUP. At first each of them kills the process at once, as by default. After take_over() the first signal
/// is only recorded, so that the program can shut down cleanly: wait() for it, watch descriptor(), or poll
/// told(). A second signal of the same kind kills the process.
/// Only one object may exist at a time, because the handler writes to an eventfd that it finds in a global
/// variable. The handler does nothing else.
class StopSignals {
 public:
  /// Throws std::system_error if no descriptor can be created.
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();  ///< restores the signal handling from before take_over()

  /// From now on the first signal is only recorded. Call this before beginning anything that must be ended
  /// cleanly; further calls have no effect. A signal that is ignored (nohup) stays ignored.
  void take_over();

  /// Becomes, and stays, readable at the first signal. Do not read from it.
  int descriptor() const { return wake_.get(); }

  /// Waits for the first signal and returns its name ("SIGTERM"). After release() without a signal, returns
  /// "". May be called on any thread.
  std::string wait() const;
  void release();

  /// The first signal's name, for polling; "" if there was none.
  static std::string told();

 private:
  struct Before {
    int signal = 0;
    struct sigaction action {};
  };
  FileDescriptor wake_;  ///< an eventfd
  std::vector<Before> before_;
};

}  // namespace turnpoint::system

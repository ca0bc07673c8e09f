#pragma once
#include <signal.h>

#include <string>
#include <vector>

#include "station/system/file_descriptor.hpp"

namespace turnpoint::system {

/// The signals that ask the program to end: SIGTERM (the service manager's, also when the machine goes down),
/// SIGINT and SIGHUP. At first each ends the process at once, as the kernel does it. After take_over() the
/// first of them is only told, for what runs to be ended in order, by a thread that wait()s, an event loop
/// that watches descriptor(), or a loop that asks what was told(); a second of the same kind ends the process
/// at once.
///
/// One of it at a time: the handler writes to an eventfd that it finds by a global, and does nothing else.
class StopSignals {
 public:
  /// Throws std::system_error without a descriptor to tell it by.
  StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;
  ~StopSignals();  ///< what was to happen at a signal before take_over() happens again

  /// From now on a signal is told: to be called before anything begins that has to be ended in order. Again:
  /// nothing. A signal that is ignored (nohup) stays ignored.
  void take_over();

  /// Becomes, and stays, readable at the first signal. Not to be read from.
  int descriptor() const { return wake_.get(); }

  /// Comes back at the first signal, with its name ("SIGTERM"); at release(), where none has come, with "".
  /// On any thread.
  std::string wait() const;
  void release();

  /// The first signal's name, for whoever looks in now and then; "" where none has come.
  static std::string told();

 private:
  struct Before {
    int signal = 0;
    struct sigaction action {};
  };
  FileDescriptor wake_;  ///< eventfd
  std::vector<Before> before_;
};

}  // namespace turnpoint::system

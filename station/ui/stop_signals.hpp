#pragma once
#include <signal.h>

#include <QObject>
#include <QSocketNotifier>
#include <vector>

namespace turnpoint::ui {

/// The signals that ask the program to end: SIGTERM (the service manager's, also when the machine goes down),
/// SIGINT and SIGHUP. At first each ends the process at once, as the kernel does it: before the first page no
/// amplifier is armed and nothing is half written that a cut of the power would not leave as well, so that
/// there is nothing to wait for. After take_over() the first of them ends the event loop, and with it in
/// order whatever runs behind the pages; a second of the same kind ends the process at once.
///
/// One of it at a time, made on the GUI thread, and living no longer than the application object. Qt's own
/// handlers on eglfs and linuxfb must be off (Application sees to that): they wait for an event loop from the
/// start on, and then leave without unwinding.
class StopSignals : public QObject {
 public:
  /// Throws std::system_error without a descriptor to wake the event loop by.
  StopSignals();
  ~StopSignals() override;  ///< what was to happen at a signal before take_over() happens again

  /// From now on a signal ends the event loop: to be called before anything begins that has to be ended in
  /// order. Again: nothing. A signal that is ignored (nohup) stays ignored.
  void take_over();

 private:
  struct Before {
    int signal = 0;
    struct sigaction action {};
  };
  int wake_;  ///< eventfd
  QSocketNotifier woken_;
  std::vector<Before> before_;
};

}  // namespace turnpoint::ui

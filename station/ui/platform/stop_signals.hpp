#pragma once
#include <QObject>
#include <QSocketNotifier>

#include "station/system/stop_signals.hpp"

namespace turnpoint::ui {

/// The stop signals of a program with a screen (see system::StopSignals): before the first page they end the
/// process at once, since no amplifier is armed and nothing is half written that a cut of the power would not
/// leave as well, so that there is nothing to wait for. After take_over() the first of them ends the event
/// loop, and with it in order whatever runs behind the pages.
///
/// Made on the GUI thread, and living no longer than the application object. Qt's own handlers on eglfs and
/// linuxfb must be off (Application sees to that): they wait for an event loop from the start on, and then
/// leave without unwinding.
class StopSignals : public QObject {
 public:
  /// Throws std::system_error if no descriptor for waking the event loop can be created.
  StopSignals();
  ~StopSignals() override;  ///< restores the signal handling from before take_over()

  /// From now on a signal ends the event loop. Call this before beginning anything that must be ended
  /// cleanly; further calls have no effect.
  void take_over();

 private:
  system::StopSignals signals_;
  QSocketNotifier woken_;
};

}  // namespace turnpoint::ui

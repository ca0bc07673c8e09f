#pragma once
#include <QObject>
#include <QSocketNotifier>

#include "station/system/stop_signals.hpp"

namespace turnpoint::ui {

/// The stop signals of a program with a screen (see system::StopSignals). Before the first page they end the
/// process at once, because no amplifier is armed and no data are being written. After take_over() the first
/// signal ends the event loop, so that a running session ends cleanly. Create this object on the GUI thread
/// and destroy it before the application object. Qt's own handlers on eglfs and linuxfb would end the program
/// without running destructors; Application switches them off.
class StopSignals : public QObject {
 public:
  /// Throws std::system_error if no descriptor for waking the event loop can be created.
  StopSignals();
  ~StopSignals() override;  ///< restores the signal handlers that were in force before take_over()

  /// From now on a signal ends the event loop. Call this before starting anything that must end cleanly.
  /// Further calls have no effect.
  void take_over();

 private:
  system::StopSignals signals_;
  QSocketNotifier woken_;
};

}  // namespace turnpoint::ui

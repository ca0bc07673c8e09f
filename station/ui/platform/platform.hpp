#pragma once
#include <QGuiApplication>
#include <QScreen>
#include <memory>

#include "station/ui/platform/service_watchdog.hpp"
#include "station/ui/platform/stop_signals.hpp"

namespace turnpoint::ui {

/// Size of the window if the program runs on a desktop.
constexpr QSize kWindow{1280, 800};

/// The application object, with a suitable Qt platform plug-in: the one in QT_QPA_PLATFORM, or a desktop's,
/// or eglfs, or else linuxfb, which needs nothing but a frame buffer. If there is no screen, Qt would kill
/// the process; before that, this class throws cli::NoScreen, or ends the process with status 2 after one
/// sentence if no display answers.
class Application {
 public:
  Application();
  /// The participant's screen, which is the first one. Throws std::runtime_error if none is connected.
  QScreen& screen() const;
  /// A second screen for the operator's view; null if there is none.
  QScreen* second_screen() const;
  /// True if windows fill the screen: on the station's own panel, and on one that is too small for several
  /// windows.
  bool is_bare_panel() const;
  QSize window_size() const;
  /// Handles the signals that ask the process to end.
  StopSignals& stop_signals() const { return *stop_signals_; }

 private:
  int argc_ = 1;
  char name_[13] = "turnpoint-ui";
  char* argv_[2] = {name_, nullptr};
  std::unique_ptr<QGuiApplication> application_;
  // Both use the application's event loop, so they are declared after the application and destroyed before
  // it.
  std::unique_ptr<ServiceWatchdog> watchdog_;
  std::unique_ptr<StopSignals> stop_signals_;
};

}  // namespace turnpoint::ui

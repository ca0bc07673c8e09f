#pragma once
#include <QGuiApplication>
#include <QScreen>
#include <memory>

#include "station/ui/platform/service_watchdog.hpp"
#include "station/ui/platform/stop_signals.hpp"

namespace turnpoint::ui {

/// The window where there is a desktop around it.
constexpr QSize kWindow{1280, 800};

/// The application object, on the back end that fits: as QT_QPA_PLATFORM says, a desktop's, eglfs, else the
/// bare frame buffer. Qt ends the process where it finds no screen; this throws terms::UsageError before.
class Application {
 public:
  Application();
  /// The screen of the participant: the first. Throws std::runtime_error where none is connected.
  QScreen& screen() const;
  /// A second screen, where the operator's view may stay open; null where there is none.
  QScreen* second_screen() const;
  /// A panel of the station's own, or one too small for a window beside others: windows fill it.
  bool is_bare_panel() const;
  QSize window_size() const;
  /// How the process ends when it is told to.
  StopSignals& stop_signals() const { return *stop_signals_; }

 private:
  int argc_ = 1;
  char name_[13] = "turnpoint-ui";
  char* argv_[2] = {name_, nullptr};
  std::unique_ptr<QGuiApplication> application_;
  // Both live in the application's event loop.
  std::unique_ptr<ServiceWatchdog> watchdog_;
  std::unique_ptr<StopSignals> stop_signals_;
};

}  // namespace turnpoint::ui

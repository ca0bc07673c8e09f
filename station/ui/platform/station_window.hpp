#pragma once
#include <QObject>
#include <QQmlApplicationEngine>
#include <QQuickWindow>
#include <QSize>
#include <memory>
#include <optional>
#include <string>

#include "station/ui/operator/design_controller.hpp"
#include "station/ui/operator/operator_controller.hpp"
#include "station/ui/operator/operator_lock.hpp"
#include "station/ui/operator/rig_controller.hpp"
#include "station/ui/operator/sessions_controller.hpp"
#include "station/ui/operator/studies_controller.hpp"
#include "station/ui/participant/session_runner.hpp"
#include "station/ui/participant/start_controller.hpp"
#include "station/view/operator_code.hpp"

namespace turnpoint::ui {

class OperatorScreen;

/// The station's only window. It shows the operator's page, if there is one, and then the participant's
/// pages, and runs the sessions behind them one after another. GUI thread only.
class StationWindow : public QObject {
  Q_OBJECT

 public:
  struct Place {
    double pixels_per_mm = 4;
    QSize size;
    bool bare_panel = false;  ///< true if the window fills the screen
    int rotation_deg = 0;     ///< the angle by which the pages are turned clockwise, see panel_rotation_deg()
  };

  struct Operator {
    /// the operator's page, which must outlive the window; null if there is none
    OperatorController* page = nullptr;
    view::OperatorCode code;  ///< the code that opens the operator's view from the participant's pages
    bool locked = false;      ///< true if the operator's page is locked from the beginning
    maintenance::DiskSources disks = {};  ///< where the page of sessions looks for USB disks
    std::string code_file = {};           ///< where a new code is stored; "" for the usual place
  };

  StationWindow(const Place& place, const Operator& allowed, const std::string& database);

  /// Asks the participant for what is not chosen yet (language, consent, code), then runs the session.
  void ask(const ChosenSession& chosen);

  /// Shows the operator's view on this screen during the lifetime of this object.
  QQuickWindow& show_live_window(QScreen& screen);

  /// Runs until the window is closed and returns the last session's summary; empty if no session was begun.
  /// Throws the exception that ended the last session, if any.
  std::optional<session::Summary> run();

  QQuickWindow& window() { return *window_; }
  SessionRunner& runner() { return runner_; }

 Q_SIGNALS:
  /// Emitted when a session is about to begin.
  void beginning();

 private:
  void begin();
  void close();

  OperatorController* operating_;
  // The operator's other pages; null if there is no operator's page.
  std::unique_ptr<StudiesController> studies_;
  std::unique_ptr<SessionsController> sessions_;
  std::unique_ptr<RigController> rig_;
  std::unique_ptr<DesignController> design_;
  session::Setup setup_;
  bool arm_ = false;
  SessionRunner runner_;
  StartController start_;
  OperatorLock lock_;
  QQmlApplicationEngine engine_, live_engine_;
  OperatorScreen* look_ = nullptr;  ///< owned by `engine_`
  QQuickWindow* window_ = nullptr;
};

}  // namespace turnpoint::ui

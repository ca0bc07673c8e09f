#pragma once
#include <QObject>
#include <QQmlApplicationEngine>
#include <QQuickWindow>
#include <QSize>
#include <optional>
#include <string>

#include "station/desk/operator_code.hpp"
#include "station/ui/operator/operator_controller.hpp"
#include "station/ui/operator/operator_lock.hpp"
#include "station/ui/participant/session_runner.hpp"
#include "station/ui/participant/start_controller.hpp"

namespace turnpoint::ui {

/// The station's only window: the participant's pages, before them the operator's if there is one, and the
/// sessions behind them, one after another. GUI thread only.
class StationWindow : public QObject {
  Q_OBJECT

 public:
  struct Place {
    double pixels_per_mm = 4;
    QSize size;
    bool bare_panel = false;  ///< the window fills the screen
  };

  struct Operator {
    OperatorController* page = nullptr;  ///< must outlive the window; null: no operator's page
    desk::OperatorCode code;             ///< opens the operator's view from the participant's pages
    bool locked = false;                 ///< lock the operator's page from the beginning
  };

  StationWindow(const Place& place, const Operator& allowed, const std::string& database);

  /// Asks the participant what is missing, then runs the session.
  void ask(const ChosenSession& chosen);

  /// Shows the operator's view on its own screen during the lifetime of this object.
  QQuickWindow& show_live_window(QScreen& screen);

  /// Runs until the window is closed. Throws what ended the last session; empty if no session was begun.
  std::optional<session::Summary> run();

  QQuickWindow& window() { return *window_; }
  SessionRunner& runner() { return runner_; }

 signals:
  /// A session is about to begin.
  void beginning();

 private:
  void begin();
  void close();

  OperatorController* operating_;
  session::Setup setup_;
  bool arm_ = false;
  SessionRunner runner_;
  StartController start_;
  OperatorLock lock_;
  QQmlApplicationEngine engine_, live_engine_;
  QQuickWindow* window_ = nullptr;
};

}  // namespace turnpoint::ui

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

/// The station's one window: the participant's pages, before them the operator's where there is one; and the
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
    bool locked = false;                 ///< the operator's page stands behind the code from the beginning on
  };

  StationWindow(const Place& place, const Operator& allowed, const std::string& database);

  /// Asks the participant what is open, then runs the session.
  void ask(const ChosenSession& chosen);

  /// The operator's view on a screen of its own, for as long as this lives.
  QQuickWindow& show_live_window(QScreen& screen);

  /// Until the window is closed. Throws what ended the last session; none where none has begun.
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

#pragma once
#include <QObject>
#include <QTemporaryDir>
#include <memory>

#include "station/ui/operator/latency_controller.hpp"
#include "station/ui/operator/live_model.hpp"
#include "station/ui/operator/operator_controller.hpp"
#include "station/ui/participant/session_bridge.hpp"

namespace turnpoint::ui {

/// The real controller of the operator's pages, for tests. It has the shipped protocols and one with
/// mistakes, a database in a temporary folder, and a live view whose content the test sets.
class OperatorDesk : public QObject {
  Q_OBJECT
  Q_PROPERTY(turnpoint::ui::OperatorController* operating READ operating CONSTANT)
  Q_PROPERTY(turnpoint::ui::LiveModel* live READ live CONSTANT)
  Q_PROPERTY(turnpoint::ui::LatencyController* latency READ latency CONSTANT)
  Q_PROPERTY(QString chosen READ chosen NOTIFY chosenChanged)

 public:
  explicit OperatorDesk(SessionBridge& bridge, QObject* parent = nullptr);
  OperatorController* operating() { return operating_.get(); }
  LiveModel* live() { return &live_; }
  LatencyController* latency() { return &latency_; }
  /// Protocol, participant, language and mode of the session that the operator began, separated by spaces; ""
  /// before that.
  QString chosen() const { return chosen_; }

  /// Simulates a press of the reference button this many milliseconds ago.
  Q_INVOKABLE void pressed(double ago_ms);
  /// The latency in milliseconds that the operator accepted; 0 before that.
  Q_INVOKABLE double keptLatencyMs() const;
  Q_INVOKABLE void tellLive(const QString& heading);

 Q_SIGNALS:
  void chosenChanged();

 private:
  QTemporaryDir folder_;
  std::unique_ptr<OperatorController> operating_;
  LiveModel live_;
  LatencyController latency_{calibration::LatencyReference::button};
  QString chosen_;
};

}  // namespace turnpoint::ui

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
  /// A second station, on which P01 had the first session of friction-training today. Its protocol asks for a
  /// day between sessions.
  Q_PROPERTY(turnpoint::ui::OperatorController* early READ early CONSTANT)
  Q_PROPERTY(turnpoint::ui::LiveModel* live READ live CONSTANT)
  Q_PROPERTY(turnpoint::ui::LatencyController* latency READ latency CONSTANT)
  Q_PROPERTY(QString chosen READ chosen NOTIFY chosenChanged)

 public:
  explicit OperatorDesk(SessionBridge& bridge, QObject* parent = nullptr);
  OperatorController* operating() { return operating_.get(); }
  OperatorController* early();
  LiveModel* live() { return &live_; }
  LatencyController* latency() { return &latency_; }
  /// Protocol, participant, language and mode of the session that the operator began, separated by spaces; ""
  /// before that.
  QString chosen() const { return chosen_; }

  /// Today's and tomorrow's dates on this machine, such as 2026-11-24.
  Q_INVOKABLE QString today() const;
  Q_INVOKABLE QString tomorrow() const;
  /// The reason that the operator gave for beginning a session early; "" before that.
  Q_INVOKABLE QString reasonGiven() const { return reason_; }

  /// Simulates a press of the reference button this many milliseconds ago.
  Q_INVOKABLE void pressed(double ago_ms);
  /// The latency in milliseconds that the operator accepted; 0 before that.
  Q_INVOKABLE double keptLatencyMs() const;
  Q_INVOKABLE void tellLive(const QString& heading, const QString& language = "en");

 Q_SIGNALS:
  void chosenChanged();

 private:
  QTemporaryDir folder_;
  QTemporaryDir early_folder_;
  std::unique_ptr<OperatorController> operating_, early_;
  LiveModel live_;
  LatencyController latency_{rig::LatencyReference::button};
  QString chosen_, reason_;
};

}  // namespace turnpoint::ui

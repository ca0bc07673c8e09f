#pragma once
#include <QObject>
#include <QStringList>
#include <QTemporaryDir>
#include <memory>
#include <thread>

#include "station/io/simulated_lines.hpp"
#include "station/session/session.hpp"
#include "station/ui/participant/session_bridge.hpp"
#include "tests/store/failing_disk.hpp"

namespace turnpoint::ui {

/// Runs sessions for tests, one after another. Each has its own thread, and its own database in a temporary
/// folder. The session is the real one: protocol file, physics, output to the null device, the amplifier's
/// guard on simulated lines, and SQLite on a simulated disk that can fill up.
class RealSession : public QObject {
  Q_OBJECT
  Q_PROPERTY(turnpoint::ui::SessionBridge* bridge READ bridge CONSTANT)
  Q_PROPERTY(bool over READ over NOTIFY ended)
  Q_PROPERTY(QString failure READ failure NOTIFY ended)

 public:
  explicit RealSession(QObject* parent = nullptr);
  ~RealSession() override;
  SessionBridge* bridge() { return &bridge_; }
  bool over() const { return over_; }
  QString failure() const { return failure_; }

  Q_INVOKABLE void start(const QString& protocol);
  /// These functions simulate the emergency stop, the amplifier's fault line, a full disk, and any other
  /// fault ("touch_gone", ...). The other faults are reported as by the thread of the device.
  Q_INVOKABLE void setStop(bool pressed);
  Q_INVOKABLE void setAmplifierFault(bool active);
  Q_INVOKABLE void setDiskFull(bool full);
  Q_INVOKABLE void find(const QString& fault);
  Q_INVOKABLE void loseFrames(int frames) { bridge_.frames_lost(frames); }
  /// Returns the values of one column of the exported trials.csv, in the order of its rows and separated by
  /// spaces.
  Q_INVOKABLE QString column(const QString& name) const;
  /// Returns the values of all events of a kind, in the same form as column().
  Q_INVOKABLE QString events(const QString& kind) const;

 Q_SIGNALS:
  void ended();

 private:
  QString database() const { return folder_.filePath("session%1.sqlite").arg(sessions_); }
  void end();  ///< stops the session if it is still running

  QList<QStringList> table(const QString& file) const;

  QTemporaryDir folder_;
  FailingDisk disk_;
  std::shared_ptr<io::SimulatedLines> lines_;
  session::Inputs inputs_;
  SessionBridge bridge_;
  int sessions_ = 0;
  QString protocol_;
  bool over_ = false;
  QString failure_;
  std::jthread thread_;
};

}  // namespace turnpoint::ui

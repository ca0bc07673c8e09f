#pragma once
#include <QObject>
#include <QStringList>
#include <QTemporaryDir>
#include <atomic>
#include <thread>

#include "station/session/session.hpp"
#include "station/ui/session_bridge.hpp"

namespace turnpoint::ui {

/// For the test of a whole session: a real one (protocol file, physics, drive to null, SQLite) on its own
/// thread, with a database in a folder that goes with it.
class RealSession : public QObject {
  Q_OBJECT
  Q_PROPERTY(turnpoint::ui::SessionBridge* bridge READ bridge CONSTANT)
  Q_PROPERTY(bool over READ over NOTIFY ended)
  Q_PROPERTY(QString failure READ failure NOTIFY ended)

 public:
  explicit RealSession(QObject* parent = nullptr);
  ~RealSession() override;  ///< stops a session that is still running
  SessionBridge* bridge() { return &bridge_; }
  bool over() const { return over_; }
  QString failure() const { return failure_; }

  Q_INVOKABLE void start(const QString& protocol);
  /// The values of one column of the exported trials.csv, in the order of its rows, between spaces.
  Q_INVOKABLE QString column(const QString& name) const;

 signals:
  void ended();

 private:
  QString database() const { return folder_.filePath("session.sqlite"); }

  QTemporaryDir folder_;
  session::Inputs inputs_;
  SessionBridge bridge_;
  bool over_ = false;
  QString failure_;
  std::jthread thread_;
};

}  // namespace turnpoint::ui

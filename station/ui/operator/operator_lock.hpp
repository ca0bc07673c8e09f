#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QTimer>
#include <functional>

#include "station/desk/code_back_off.hpp"
#include "station/desk/operator_code.hpp"
#include "station/ui/platform/newest_job.hpp"

namespace turnpoint::ui {

/// What stands between the participant's screen and the operator's pages. A code is compared on a thread of
/// its own, since hashing takes as long as several frames; after wrong ones it takes none for a while, and
/// each is written to the log. GUI thread only.
class OperatorLock : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(int digits READ digits CONSTANT)  ///< that a code has at most
  Q_PROPERTY(bool checking READ checking NOTIFY changed)
  Q_PROPERTY(int waitS READ wait_s NOTIFY changed)  ///< seconds until it takes the next code

 public:
  using Clock = std::function<double()>;  ///< seconds, monotonic

  explicit OperatorLock(desk::OperatorCode code, QObject* parent = nullptr);
  OperatorLock(desk::OperatorCode code, Clock clock, QObject* parent = nullptr);

  int digits() const { return static_cast<int>(desk::OperatorCode::longest); }
  bool checking() const { return checking_; }
  int wait_s() const;

  /// Ends in opened() or refused(); ignored while it checks or waits.
  Q_INVOKABLE void enter(const QString& typed);

 signals:
  void opened();
  void refused();
  void changed();

 private:
  void judge(bool right);

  desk::OperatorCode code_;
  Clock clock_;
  desk::CodeBackOff back_off_;
  bool checking_ = false;
  QTimer second_;
  NewestJob job_;  // last: its thread has ended before what it uses goes
};

}  // namespace turnpoint::ui

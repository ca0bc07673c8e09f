#pragma once
#include <QObject>
#include <QQmlEngine>
#include <QTimer>
#include <functional>
#include <string>
#include <utility>

#include "station/ui/platform/newest_job.hpp"
#include "station/view/operator_code.hpp"

namespace turnpoint::ui {

/// Protects the operator's pages on the participant's screen. A code is compared on a separate thread,
/// because hashing takes as long as several frames. After wrong codes it refuses every code for a while
/// (view/operator_code.hpp). The log says how many codes were wrong in a row. GUI thread only.
class OperatorLock : public QObject {
  Q_OBJECT
  QML_ELEMENT
  QML_UNCREATABLE("made by the program")
  Q_PROPERTY(int digits READ digits CONSTANT)  ///< largest number of digits of a code
  Q_PROPERTY(bool builtIn READ built_in NOTIFY changed)
  Q_PROPERTY(
      QString shownCode READ shown_code NOTIFY changed)  ///< the built-in code; "" for one that was chosen
  Q_PROPERTY(bool checking READ checking NOTIFY changed)
  Q_PROPERTY(int waitS READ wait_s NOTIFY changed)  ///< number of seconds until the next code is accepted

 public:
  /// True as long as nobody has chosen a code. The code is then shown, because it is no secret.
  bool built_in() const { return code_.is_built_in(); }
  QString shown_code() const { return built_in() ? view::OperatorCode::built_in : ""; }
  using Clock = std::function<double()>;  ///< returns the time of a monotonic clock in s

  explicit OperatorLock(view::OperatorCode code, QObject* parent = nullptr);
  OperatorLock(view::OperatorCode code, Clock clock, QObject* parent = nullptr);

  int digits() const { return static_cast<int>(view::OperatorCode::longest); }
  bool checking() const { return checking_; }
  int wait_s() const;

  /// Checks a typed code, then emits opened() or refused(). Ignored while a code is being checked or the
  /// waiting time has not ended.
  Q_INVOKABLE void enter(const QString& typed);
  /// Makes these digits the operator's code and stores it. Then emits chosen() or, if the code is not
  /// possible or cannot be stored, refused().
  Q_INVOKABLE void choose(const QString& digits);
  /// Where choose() stores the code; "" (the default) is the first of view::operator_code_files().
  void store_in(std::string file) { file_ = std::move(file); }

 Q_SIGNALS:
  void opened();
  void chosen();
  void refused();
  void changed();

 private:
  void judge(bool right);

  view::OperatorCode code_;
  Clock clock_;
  std::string file_;
  view::CodeBackOff back_off_;
  bool checking_ = false;
  QTimer second_;
  NewestJob job_;  // The last member, so that its thread ends before the objects that it uses are destroyed.
};

}  // namespace turnpoint::ui

#include "station/ui/operator/operator_lock.hpp"

#include <chrono>
#include <cmath>
#include <utility>

namespace turnpoint::ui {

OperatorLock::OperatorLock(view::OperatorCode code, QObject* parent)
    : OperatorLock(
          std::move(code),
          [] {
            return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
          },
          parent) {}

OperatorLock::OperatorLock(view::OperatorCode code, Clock clock, QObject* parent)
    : QObject(parent), code_(std::move(code)), clock_(std::move(clock)), job_(*this) {
  second_.setInterval(1000);
  connect(&second_, &QTimer::timeout, this, [this] {
    if (wait_s() == 0) second_.stop();
    Q_EMIT changed();
  });
}

int OperatorLock::wait_s() const { return static_cast<int>(std::ceil(back_off_.wait_s(clock_()))); }

void OperatorLock::enter(const QString& typed) {
  if (checking_ || wait_s() > 0 || typed.isEmpty()) return;
  checking_ = true;
  Q_EMIT changed();
  job_.start([this, code = code_, text = typed.toStdString()](const std::stop_token&) {
    bool right = false;
    try {
      right = code.opens(text);
    } catch (const std::exception& error) {
      qWarning("%s", error.what());
    }
    return [this, right] { judge(right); };
  });
}

void OperatorLock::choose(const QString& digits) {
  if (checking_ || digits.isEmpty()) return;
  checking_ = true;
  Q_EMIT changed();
  const auto file = file_.empty() ? view::operator_code_files().front() : file_;
  job_.start([this, file, text = digits.toStdString()](const std::stop_token&) -> std::function<void()> {
    try {
      auto code = view::OperatorCode::of_digits(text);
      view::store_operator_code(code, file);
      return [this, code = std::move(code)] {
        code_ = code;
        checking_ = false;
        Q_EMIT changed();
        Q_EMIT chosen();
      };
    } catch (const std::exception& error) {
      qWarning("%s", error.what());
      return [this] {
        checking_ = false;
        Q_EMIT changed();
        Q_EMIT refused();
      };
    }
  });
}

void OperatorLock::judge(bool right) {
  checking_ = false;
  if (right) {
    back_off_.right();
    Q_EMIT changed();
    Q_EMIT opened();
    return;
  }
  back_off_.wrong(clock_());
  qWarning("operator's code: %d wrong codes in a row; the next code is accepted in %d s",
           back_off_.wrong_tries(), wait_s());
  if (wait_s() > 0) second_.start();
  Q_EMIT changed();
  Q_EMIT refused();
}

}  // namespace turnpoint::ui

#include "moc_operator_lock.cpp"

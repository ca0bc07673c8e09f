#include "station/ui/platform/newest_job.hpp"

#include <utility>

#include "station/ui/platform/vector_state.hpp"

namespace turnpoint::ui {

NewestJob::NewestJob(QObject& owner)
    : owner_(owner), thread_([this](const std::stop_token& stop) { run(stop); }) {}

NewestJob::~NewestJob() {
  thread_.request_stop();
  const std::lock_guard lock(mutex_);
  running_.request_stop();
}

void NewestJob::start(Job job) {
  waiting_ = {};
  {
    const std::lock_guard lock(mutex_);
    wanted_ = Wanted{++newest_, std::move(job)};
    running_.request_stop();
  }
  changed_.notify_one();
}

void NewestJob::stop() {
  const std::lock_guard lock(mutex_);
  stop_next_ = wanted_.has_value();
  running_.request_stop();
}

void NewestJob::hold(bool held) {
  held_ = held;
  if (held_) return;
  // Not at once: the release of the finger may still have to reach the control under it.
  const auto resume = [this] {
    if (!held_ && waiting_) std::exchange(waiting_, {})();
  };
  QMetaObject::invokeMethod(&owner_, resume, Qt::QueuedConnection);
}

void NewestJob::finish(int number, const std::function<void()>& then) {
  if (number != newest_ || !then) return;
  if (held_)
    waiting_ = then;
  else
    then();
}

void NewestJob::abandon() {
  ++newest_;
  waiting_ = {};
  const std::lock_guard lock(mutex_);
  wanted_.reset();
  running_.request_stop();
}

void NewestJob::run(const std::stop_token& stop) {
  clear_upper_halves();
  for (;;) {
    Wanted now;
    std::stop_token abandoned;
    {
      std::unique_lock lock(mutex_);
      if (!changed_.wait(lock, stop, [this] { return wanted_.has_value(); }) || stop.stop_requested()) return;
      now = *std::exchange(wanted_, std::nullopt);
      running_ = {};
      if (std::exchange(stop_next_, false)) running_.request_stop();
      abandoned = running_.get_token();
    }
    auto then = now.job(abandoned);
    QMetaObject::invokeMethod(
        &owner_, [this, number = now.number, then = std::move(then)] { finish(number, then); },
        Qt::QueuedConnection);
  }
}

}  // namespace turnpoint::ui

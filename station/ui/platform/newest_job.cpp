#include "station/ui/platform/newest_job.hpp"

#include <utility>

namespace turnpoint::ui {

NewestJob::NewestJob(QObject& owner)
    : owner_(owner), thread_([this](const std::stop_token& stop) { run(stop); }) {}

NewestJob::~NewestJob() {
  thread_.request_stop();
  const std::lock_guard lock(mutex_);
  running_.request_stop();
}

void NewestJob::start(Job job) {
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

void NewestJob::abandon() {
  ++newest_;
  const std::lock_guard lock(mutex_);
  wanted_.reset();
  running_.request_stop();
}

void NewestJob::run(const std::stop_token& stop) {
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
        &owner_,
        [this, number = now.number, then = std::move(then)] {
          if (number == newest_ && then) then();
        },
        Qt::QueuedConnection);
  }
}

}  // namespace turnpoint::ui

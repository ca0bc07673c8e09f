#include "station/ui/participant/frame_watch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace turnpoint::ui {

void LateFrames::waited(std::int64_t from_ns, std::int64_t to_ns) {
  const int frames = lost(to_ns - std::max(from_ns, counted_ns_), refresh_Hz_);
  if (frames == 0) return;
  count_ += frames;
  counted_ns_ = to_ns;
}

int LateFrames::lost(std::int64_t waited_ns, double refresh_Hz) {
  const double refreshes = static_cast<double>(waited_ns) * 1e-9 * refresh_Hz;
  return std::max(0, static_cast<int>(std::floor(refreshes)) - 1);
}

FrameWatch::FrameWatch(Clock clock, QObject* parent) : QObject(parent), clock_(std::move(clock)) {
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &FrameWatch::beat);
}

void FrameWatch::follow(QQuickWindow* window, double refresh_Hz) {
  window_ = window;
  refresh_Hz_ = refresh_Hz > 0 ? refresh_Hz : 60;
  timer_.setInterval(std::max(1, static_cast<int>(1e3 / refresh_Hz_)));
  // Qt calls this on its rendering thread, which may be another thread, so it only reads the clock.
  connect(
      window, &QQuickWindow::frameSwapped, this, [this] { swapped(); }, Qt::DirectConnection);
  connect(
      window, &QQuickWindow::afterSynchronizing, this, [this] { drawn(); }, Qt::DirectConnection);
}

void FrameWatch::asked() {
  if (!timer_.isActive()) begin();
  asked_ns_ = clock_();
  if (window_ != nullptr) window_->update();
}

void FrameWatch::timed() {
  timed_ = true;
  asked();
}

int FrameWatch::end() {
  if (!timer_.isActive()) return 0;
  // count the time since the timer last ran; if the event loop was blocked, the timer's next call would come
  // too late
  beat();
  timer_.stop();
  const std::scoped_lock lock(mutex_);
  return late_.count();
}

void FrameWatch::begin() {
  beat_ns_ = clock_();
  timer_.start();
  const std::scoped_lock lock(mutex_);
  late_ = LateFrames(refresh_Hz_);
}

void FrameWatch::beat() { waited(std::exchange(beat_ns_, clock_())); }

// A frame that was already being drawn when timed() was called shows the old page, so its time does not
// count.
void FrameWatch::drawn() {
  if (timed_.exchange(false)) drawn_ = true;
}

void FrameWatch::swapped() {
  if (drawn_.exchange(false)) Q_EMIT presented(clock_());
  if (const auto asked = asked_ns_.exchange(0); asked != 0) waited(asked);
}

void FrameWatch::waited(std::int64_t from_ns) {
  const auto now = clock_();
  const std::scoped_lock lock(mutex_);
  late_.waited(from_ns, now);
}

}  // namespace turnpoint::ui

#include "moc_frame_watch.cpp"

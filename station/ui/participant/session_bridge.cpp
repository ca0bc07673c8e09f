#include "station/ui/participant/session_bridge.hpp"

#include <QMouseEvent>
#include <QTouchEvent>
#include <QWindow>
#include <algorithm>
#include <utility>

#include "station/core/limits.hpp"

namespace turnpoint::ui {

namespace input = session::input;

SessionBridge::SessionBridge(Clock clock, Sink sink, QObject* parent)
    : QObject(parent), clock_(std::move(clock)), sink_(std::move(sink)), page_(clock_, this) {
  flush_.setSingleShot(true);
  flush_.setInterval(static_cast<int>(core::kTouchToAnswer_ns / 1'000'000) + 1);
  connect(&flush_, &QTimer::timeout, this, &SessionBridge::flush);
}

void SessionBridge::show(const session::Page& page) {
  QMetaObject::invokeMethod(
      this,
      [this, page] {
        left_ = false;
        page_.set(page);
        Q_EMIT shown();
      },
      Qt::QueuedConnection);
}

void SessionBridge::guide(const session::Guidance& guidance) {
  QMetaObject::invokeMethod(
      this, [this, guidance] { page_.guide(guidance); }, Qt::QueuedConnection);
}

void SessionBridge::watch(QObject* window) { window->installEventFilter(this); }

SessionBridge::Stamp SessionBridge::stamped(int touch_id) const {
  const auto found =
      std::find_if(pending_.rbegin(), pending_.rend(), [&](const Pending& p) { return p.id == touch_id; });
  return found != pending_.rend() ? found->stamp : Stamp{clock_(), 0};
}

void SessionBridge::answer(int index, const Stamp& stamp) {
  const auto found = std::find_if(pending_.begin(), pending_.end(),
                                  [&](const Pending& p) { return p.stamp.number == stamp.number; });
  Pending touch{kMouse, stamp, -1, -1};
  if (found != pending_.end()) {
    touch = *found;
    pending_.erase(found);
  }
  push_touch(input::Answer{index}, touch);
}

void SessionBridge::note_touch(int id, QPointF position, const QObject* window) {
  const auto* area = qobject_cast<const QWindow*>(window);
  const double width = area != nullptr ? area->width() : 1, height = area != nullptr ? area->height() : 1;
  pending_.push_back({id, {clock_(), ++touches_}, position.x() / width, position.y() / height});
  if (!flush_.isActive()) flush_.start();
}

void SessionBridge::flush() {
  const auto due_ns = clock_() - core::kTouchToAnswer_ns;
  for (const auto& touch : pending_)
    if (touch.stamp.time_ns <= due_ns) push_touch(input::Touch{}, touch);
  std::erase_if(pending_, [&](const Pending& p) { return p.stamp.time_ns <= due_ns; });
  if (!pending_.empty()) flush_.start();
}

void SessionBridge::push_touch(input::Any content, const Pending& touch) {
  const auto kernel_ns = kernel_time_ ? kernel_time_(touch.x, touch.y, touch.stamp.time_ns) : std::nullopt;
  sink_({kernel_ns.value_or(touch.stamp.time_ns), std::move(content),
         kernel_ns ? session::TimeQuality::kernel : session::TimeQuality::toolkit});
}

void SessionBridge::next() {
  if (!std::exchange(left_, true)) push(input::Next{});
}
void SessionBridge::back() {
  if (!std::exchange(left_, true)) push(input::Back{});
}
void SessionBridge::again() {
  if (!std::exchange(left_, true)) push(input::Again{});
}
void SessionBridge::choose(int index) { push(input::Answer{index}); }
void SessionBridge::moveSlider(double value) { push(input::Slider{value}); }
void SessionBridge::answerValue(double value) { push(input::Value{value}); }
void SessionBridge::pause() { push(input::Pause{}); }
void SessionBridge::stop() { push(input::Stop{}); }

void SessionBridge::repeat() { push(input::Repeat{}); }
void SessionBridge::arm() { push(input::Arm{}); }

// The following functions do not use push(). It clears the pending touches, as if a button on the page had
// been pressed.

void SessionBridge::annotate(const QString& text) {
  const auto note = text.trimmed().toStdString();
  if (!note.empty()) sink_({clock_(), input::Note{note}});
}

void SessionBridge::frames_lost(int frames) {
  if (frames > 0) sink_({clock_(), input::FramesLost{frames}});
}

void SessionBridge::signal_shown(std::int64_t time_ns, std::int64_t due_ns) {
  sink_({time_ns, input::SignalShown{1e-9 * static_cast<double>(time_ns - due_ns)}});
}

void SessionBridge::push(input::Any content) {
  // forget the tap that pressed this button; otherwise it would count as a stray touch in the next trial
  pending_.clear();
  sink_({clock_(), std::move(content)});
}

bool SessionBridge::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::TouchBegin || event->type() == QEvent::TouchUpdate) {
    const auto& touch = *static_cast<QTouchEvent*>(event);
    for (const auto& point : touch.points()) {
      if (point.state() == QEventPoint::Pressed) note_touch(point.id(), point.scenePosition(), watched);
    }
  }
  // A mouse event that Qt synthesises from a touch has already been counted as that touch.
  if (event->type() == QEvent::MouseButtonPress &&
      static_cast<QMouseEvent*>(event)->pointerType() != QPointingDevice::PointerType::Finger) {
    note_touch(kMouse, static_cast<QMouseEvent*>(event)->scenePosition(), watched);
  }
  return QObject::eventFilter(watched, event);
}

}  // namespace turnpoint::ui

#include "moc_session_bridge.cpp"

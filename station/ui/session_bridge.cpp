#include "station/ui/session_bridge.hpp"

#include <QMouseEvent>
#include <QTouchEvent>
#include <algorithm>
#include <utility>

namespace turnpoint::ui {

namespace {
/// How long a touch may wait to become an answer: the touch field's settling time and its timer's slack.
constexpr std::int64_t kClaim_ns = 60'000'000;
}  // namespace

SessionBridge::SessionBridge(Clock clock, Sink sink, QObject* parent)
    : QObject(parent), clock_(std::move(clock)), sink_(std::move(sink)), page_(this) {
  flush_.setSingleShot(true);
  flush_.setInterval(static_cast<int>(kClaim_ns / 1'000'000) + 1);
  connect(&flush_, &QTimer::timeout, this, &SessionBridge::flush);
}

void SessionBridge::show(const session::Page& page) {
  QMetaObject::invokeMethod(
      this,
      [this, page] {
        page_.set(page);
        emit shown();
      },
      Qt::QueuedConnection);
}

void SessionBridge::watch(QObject* window) { window->installEventFilter(this); }

std::int64_t SessionBridge::began_ns(int touch_id) const {
  const auto found =
      std::find_if(pending_.rbegin(), pending_.rend(), [&](const Pending& p) { return p.id == touch_id; });
  return found != pending_.rend() ? found->time_ns : clock_();
}

void SessionBridge::answer(int index, std::int64_t time_ns) {
  session::Input input;
  input.time_ns = time_ns;
  input.kind = session::InputKind::answer;
  input.value = index;
  std::erase_if(pending_, [&](const Pending& p) { return p.time_ns == time_ns; });
  sink_(std::move(input));
}

void SessionBridge::note_touch(int id) {
  pending_.push_back({id, clock_()});
  if (!flush_.isActive()) flush_.start();
}

void SessionBridge::flush() {
  const auto due_ns = clock_() - kClaim_ns;
  for (const auto& touch : pending_) {
    if (touch.time_ns > due_ns) continue;
    session::Input input;
    input.time_ns = touch.time_ns;
    input.kind = session::InputKind::touch_down;
    sink_(std::move(input));
  }
  std::erase_if(pending_, [&](const Pending& p) { return p.time_ns <= due_ns; });
  if (!pending_.empty()) flush_.start();
}

void SessionBridge::next() { push(session::InputKind::next); }
void SessionBridge::moveSlider(double value) { push(session::InputKind::slider, 0, value); }
void SessionBridge::pause() { push(session::InputKind::pause); }
void SessionBridge::stop() { push(session::InputKind::stop); }

void SessionBridge::push(session::InputKind kind, int value, double number) {
  session::Input input;
  input.time_ns = clock_();
  input.kind = kind;
  input.value = value;
  input.number = number;
  sink_(std::move(input));
}

bool SessionBridge::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::TouchBegin || event->type() == QEvent::TouchUpdate) {
    const auto& touch = *static_cast<QTouchEvent*>(event);
    for (const auto& point : touch.points()) {
      if (point.state() == QEventPoint::Pressed) note_touch(point.id());
    }
  }
  // A mouse event that Qt makes up from a touch has been counted as that touch.
  if (event->type() == QEvent::MouseButtonPress &&
      static_cast<QMouseEvent*>(event)->pointerType() != QPointingDevice::PointerType::Finger) {
    note_touch(kMouse);
  }
  return QObject::eventFilter(watched, event);
}

}  // namespace turnpoint::ui

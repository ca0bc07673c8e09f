#include "station/ui/session_bridge.hpp"

#include <QMouseEvent>
#include <QTouchEvent>
#include <utility>

namespace turnpoint::ui {

SessionBridge::SessionBridge(Clock clock, Sink sink, QObject* parent)
    : QObject(parent), clock_(std::move(clock)), sink_(std::move(sink)), page_(this) {}

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

void SessionBridge::answer(int index, std::int64_t time_ns, session::TimeQuality quality) {
  session::Input input;
  input.time_ns = time_ns;
  input.kind = session::InputKind::answer;
  input.value = index;
  input.quality = quality;
  sink_(std::move(input));
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
      if (point.state() == QEventPoint::Pressed) push(session::InputKind::touch_down);
    }
  }
  // A mouse event that Qt makes up from a touch has been counted as that touch.
  if (event->type() == QEvent::MouseButtonPress &&
      static_cast<QMouseEvent*>(event)->pointerType() != QPointingDevice::PointerType::Finger) {
    push(session::InputKind::touch_down);
  }
  return QObject::eventFilter(watched, event);
}

}  // namespace turnpoint::ui

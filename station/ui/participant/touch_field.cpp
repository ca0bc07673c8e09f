#include "station/ui/participant/touch_field.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::ui {

TouchField::TouchField(QQuickItem* parent) : QQuickItem(parent) {
  setAcceptTouchEvents(true);
  setAcceptedMouseButtons(Qt::LeftButton);
  timer_.setSingleShot(true);
  timer_.setTimerType(Qt::PreciseTimer);
  connect(&timer_, &QTimer::timeout, this, &TouchField::settle);
}

void TouchField::set_open(bool open) {
  if (open == judge_.is_open()) return;
  if (open) {
    judge_.open();
  } else {
    judge_.close();
  }
  timer_.stop();
  update_pressed();
  Q_EMIT openChanged();
}

void TouchField::again() {
  judge_.again();
  update_pressed();
}

int TouchField::target_at(QPointF position) const {
  if (row_ == nullptr || count_ <= 0) return -1;
  const QPointF inside = mapToItem(row_, position);
  const int columns = std::max(1, columns_), rows = (count_ + columns - 1) / columns;
  const auto cell = [this](double at, double length, int cells) {
    const double pitch = (length + gap_) / cells;
    const int index = static_cast<int>(std::floor(at / pitch));
    return index >= 0 && index < cells && at - index * pitch < pitch - gap_ ? index : -1;
  };
  const int column = cell(inside.x(), row_->width(), columns), row = cell(inside.y(), row_->height(), rows);
  const int index = row * columns + column;
  return column >= 0 && row >= 0 && index < count_ ? index : -1;
}

void TouchField::down(int id, QPointF position, double diameter_mm) {
  const auto touch = bridge_->stamped(id);
  judge_.down({touch.time_ns, target_at(position), diameter_mm, touch.number});
  if (const auto due_ns = judge_.due_ns()) {
    const auto left_ms = (*due_ns - bridge_->now_ns()) / 1'000'000 + 1;
    timer_.start(std::max(1, static_cast<int>(left_ms)));
  }
  update_pressed();
}

void TouchField::settle() {
  if (const auto answer = judge_.decide(bridge_->now_ns())) {
    bridge_->answer(answer->target, {answer->time_ns, answer->number});
  } else if (judge_.due_ns()) {
    timer_.start(1);
  }
  update_pressed();
}

void TouchField::update_pressed() {
  const int pressed = judge_.pressed();
  if (pressed == pressed_) return;
  pressed_ = pressed;
  if (pressed_ >= 0) bridge_->pressed();
  Q_EMIT pressedChanged();
}

void TouchField::touchEvent(QTouchEvent* event) {
  event->accept();
  if (event->type() == QEvent::TouchCancel) {
    judge_.cancel();
    update_pressed();
    return;
  }
  for (const auto& point : event->points()) {
    if (point.state() != QEventPoint::Pressed) continue;
    const auto size = point.ellipseDiameters();
    down(point.id(), point.position(), std::max(size.width(), size.height()) / pixels_per_mm_);
  }
}

void TouchField::mousePressEvent(QMouseEvent* event) {
  event->accept();
  down(SessionBridge::kMouse, event->position(), 0);
}

}  // namespace turnpoint::ui

#include "moc_touch_field.cpp"

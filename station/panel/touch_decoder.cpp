#include "station/panel/touch_decoder.hpp"

#include <stdexcept>
#include <string>

namespace turnpoint::panel {

namespace {

std::int64_t time_of(const input_event& event) {
  return std::int64_t{event.input_event_sec} * 1'000'000'000 + std::int64_t{event.input_event_usec} * 1000;
}

double fraction(int value, const AxisRange& range) {
  return static_cast<double>(value - range.lowest) / (range.highest - range.lowest);
}

void check(const char* axis, const AxisRange& range) {
  if (range.highest <= range.lowest)
    throw std::invalid_argument(std::string("touch panel: axis ") + axis + " reports " +
                                std::to_string(range.lowest) + " ... " + std::to_string(range.highest) +
                                "; the second must be the larger");
}

}  // namespace

TouchDecoder::TouchDecoder(TouchProtocol protocol, AxisRange x, AxisRange y)
    : protocol_(protocol), x_(x), y_(y) {
  check("x", x);
  check("y", y);
}

std::vector<PanelTouch> TouchDecoder::handle(const input_event& event) {
  if (event.type == EV_SYN && event.code == SYN_DROPPED) {
    dropped_ = true;
    return {};
  }
  if (event.type == EV_SYN && event.code == SYN_REPORT) {
    if (!dropped_) return report(time_of(event));
    dropped_ = false;
    for (auto& [slot, finger] : fingers_) finger.began = false;
    return {};
  }
  if (dropped_) return {};
  if (event.type == EV_ABS) handle_axis(event);
  if (event.type == EV_KEY && event.code == BTN_TOUCH && protocol_ == TouchProtocol::single)
    fingers_[0].began = event.value == 1;
  return {};
}

void TouchDecoder::handle_axis(const input_event& event) {
  if (protocol_ == TouchProtocol::single) {
    if (event.code == ABS_X) fingers_[0].x = event.value;
    if (event.code == ABS_Y) fingers_[0].y = event.value;
    return;
  }
  switch (event.code) {
    case ABS_MT_SLOT:
      slot_ = event.value;
      break;
    case ABS_MT_TRACKING_ID:
      // The kernel leaves out what has not changed: a finger that comes down where the last one was has no
      // new position, so positions outlive the finger.
      fingers_[slot_].began = event.value >= 0;
      break;
    case ABS_MT_POSITION_X:
      fingers_[slot_].x = event.value;
      break;
    case ABS_MT_POSITION_Y:
      fingers_[slot_].y = event.value;
      break;
    default:
      break;
  }
}

std::vector<PanelTouch> TouchDecoder::report(std::int64_t time_ns) {
  std::vector<PanelTouch> touches;
  for (auto& [slot, finger] : fingers_) {
    if (finger.began && finger.x && finger.y)
      touches.push_back({time_ns, fraction(*finger.x, x_), fraction(*finger.y, y_)});
    finger.began = false;
  }
  return touches;
}

}  // namespace turnpoint::panel

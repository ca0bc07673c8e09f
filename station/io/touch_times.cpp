#include "station/io/touch_times.hpp"

#include <cmath>
#include <vector>

namespace turnpoint::io {
namespace {

double fraction(int value, const AxisRange& range) {
  return static_cast<double>(value - range.lowest) / (range.highest - range.lowest);
}

}  // namespace

std::vector<PanelTouch> TouchDecoder::report(std::int64_t time_ns, std::span<const Finger> fingers) {
  std::vector<PanelTouch> touches;
  for (std::size_t k = 0; k < fingers.size(); ++k) {
    const auto& finger = fingers[k];
    const bool stayed = k < before_.size() && before_[k].id == finger.id;
    if (finger.id && !stayed) touches.push_back({time_ns, fraction(finger.x, x_), fraction(finger.y, y_)});
  }
  resynchronise(fingers);
  return touches;
}

void TouchDecoder::resynchronise(std::span<const Finger> fingers) {
  before_.assign(fingers.begin(), fingers.end());
}

void TouchTimes::add(const PanelTouch& touch) {
  const std::lock_guard lock(mutex_);
  touches_.push_back(touch);
  while (touches_.front().time_ns < touch.time_ns - 2 * rules_.latest_ns) touches_.pop_front();
}

std::optional<std::int64_t> TouchTimes::claim(double x, double y, std::int64_t seen_ns) {
  const std::lock_guard lock(mutex_);
  const auto fits = [&](const PanelTouch& touch) {
    return touch.time_ns <= seen_ns && touch.time_ns >= seen_ns - rules_.latest_ns &&
           std::abs(touch.x - x) <= rules_.nearness && std::abs(touch.y - y) <= rules_.nearness;
  };
  std::vector<std::int64_t> times;
  std::erase_if(touches_, [&](const PanelTouch& touch) {
    if (!fits(touch)) return false;
    times.push_back(touch.time_ns);
    return true;
  });
  if (times.size() != 1) return std::nullopt;
  return times.front();
}

}  // namespace turnpoint::io

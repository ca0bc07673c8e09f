#include "station/touch/touch_decoder.hpp"

namespace turnpoint::touch {

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

}  // namespace turnpoint::touch

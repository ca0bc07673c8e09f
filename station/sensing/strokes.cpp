#include "station/sensing/strokes.hpp"

#include <cmath>

namespace turnpoint::sensing {
namespace {

constexpr double slowest_mm_s = 10, shortest_mm = 30, end_mm = 5;

int direction_of(const FingerPoint& point) {
  if (!(std::abs(point.speed_mm_s) > slowest_mm_s)) return 0;
  return point.speed_mm_s > 0 ? 1 : -1;
}

}  // namespace

std::vector<Stroke> find_strokes(std::span<const FingerPoint> track) {
  std::vector<Stroke> all;
  for (std::size_t first = 0, end = 0; first < track.size(); first = end) {
    const int direction = direction_of(track[first]);
    for (end = first + 1; end < track.size() && direction_of(track[end]) == direction;) ++end;
    const double from_mm = track[first].position_mm, to_mm = track[end - 1].position_mm;
    if (direction == 0 || !(std::abs(to_mm - from_mm) >= shortest_mm)) continue;
    Stroke stroke{first, end, direction};
    while (std::abs(track[stroke.first].position_mm - from_mm) < end_mm) ++stroke.first;
    while (std::abs(track[stroke.end - 1].position_mm - to_mm) < end_mm) --stroke.end;
    all.push_back(stroke);
  }
  return all;
}

}  // namespace turnpoint::sensing

#include "station/desk/finger_gauges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace turnpoint::desk {

namespace {

using Range = std::optional<std::pair<double, double>>;

constexpr double kForce_N = 2, kSpeed_mm_s = 200;  // ends of the scales if the protocol asks for nothing

Gauge gauge(std::optional<double> value, const Range& asked, double full_scale, std::string figure) {
  if (asked) full_scale = 1.5 * asked->second;
  Gauge made;
  if (asked) made.low = asked->first / full_scale, made.high = asked->second / full_scale;
  if (!value || !std::isfinite(*value)) return made;
  made.value = std::clamp(std::round(100 * *value / full_scale) / 100, 0.0, 1.0);
  made.figure = std::move(figure);
  return made;
}

}  // namespace

FingerGauges finger_gauges(const std::optional<session::FingerSeen>& finger,
                           const std::optional<protocol::Sensing>& asked, const rig::Rig& rig) {
  const auto force = asked ? asked->normal_N : Range{}, speed = asked ? asked->speed_mm_s : Range{};
  std::optional<double> normal_N, speed_mm_s, position_mm;
  if (finger) {
    normal_N = finger->normal_N;
    speed_mm_s = std::abs(finger->speed_mm_s);
    position_mm = finger->position_mm;
  }
  const double length_mm = 1e3 * rig.surface.length_m;
  return {gauge(normal_N, force, kForce_N, fmt::format("{:.2f} N", normal_N.value_or(0))),
          gauge(speed_mm_s, speed, kSpeed_mm_s, fmt::format("{:.0f} mm/s", speed_mm_s.value_or(0))),
          gauge(position_mm, {}, length_mm, fmt::format("{:.0f} mm", position_mm.value_or(0)))};
}

}  // namespace turnpoint::desk

#include "station/session/guidance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace turnpoint::session {

namespace {

/// A bar ends at one and a half times the upper end of the range that the protocol asks for, so that values
/// above the range can be seen too.
double full_scale(const std::pair<double, double>& range) { return 1.5 * range.second; }

std::optional<Guidance::Bar> empty_bar(const std::optional<std::pair<double, double>>& range) {
  if (!range) return std::nullopt;
  return Guidance::Bar{{}, range->first / full_scale(*range), range->second / full_scale(*range)};
}

void move_bar(std::optional<Guidance::Bar>& bar, const std::optional<std::pair<double, double>>& range,
              std::optional<double> value) {
  if (!bar) return;
  // Round to one percent: finer movements cannot be seen.
  bar->value = value
                   ? std::optional(std::clamp(std::round(100 * *value / full_scale(*range)) / 100, 0.0, 1.0))
                   : std::nullopt;
}

}  // namespace

Guide::Guide(const std::optional<protocol::Sensing>& sensing) {
  if (!sensing || !sensing->guidance) return;
  sensing_ = sensing;
  bars_ = Guidance{empty_bar(sensing->normal_N), empty_bar(sensing->speed_mm_s)};
  if (const auto& speed = sensing->speed_mm_s) bars_->pace_mm_s = (speed->first + speed->second) / 2;
}

bool Guide::move(const std::optional<sensing::FingerNow>& finger) {
  if (!bars_ || bars_->frozen) return false;
  const auto before = *bars_;
  const bool touches = finger && finger->contact;
  move_bar(bars_->force, sensing_->normal_N, touches ? std::optional(finger->normal_N) : std::nullopt);
  const bool moves = touches && std::isfinite(finger->speed_mm_s);
  move_bar(bars_->speed, sensing_->speed_mm_s,
           moves ? std::optional(std::abs(finger->speed_mm_s)) : std::nullopt);
  return !(*bars_ == before);
}

bool Guide::freeze(bool during_stimulus) {
  if (!bars_) return false;
  return std::exchange(bars_->frozen, during_stimulus && !sensing_->live_guidance) != bars_->frozen;
}

}  // namespace turnpoint::session

#include "station/simulation/finger.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace turnpoint::simulation {

double minimum_jerk(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return s * s * s * (10 + s * (-15 + s * 6));
}

double minimum_jerk_speed(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return 30 * s * s * (1 - s) * (1 - s);
}

FingerModel::FingerModel(const Finger& finger, double step_s, int frames_per_step, std::uint64_t seed)
    : finger_(finger),
      step_s_(step_s),
      rate_Hz_(frames_per_step / step_s),
      film_(1 - std::exp(-2 * std::numbers::pi * finger.film_Hz * step_s)),
      normal_noise_(seed, 20, 1 / step_s, 0.1, 25.7),
      friction_noise_(seed, 21, 1 / step_s, 0.1, 410) {
  state_.finger_m = state_.contact_m = finger.from_m;
}

void FingerModel::touch(const Touch& touch) {
  finger_.touches = {touch};
  touch_ = 0;
}

void FingerModel::lift(std::int64_t frame) {
  for (auto& touch : finger_.touches) touch.to_frame = std::min(touch.to_frame, frame);
}

bool FingerModel::scheduled(std::int64_t frame) {
  const auto& touches = finger_.touches;
  while (touch_ < touches.size() && frame >= touches[touch_].to_frame) ++touch_;
  return touch_ < touches.size() && frame >= touches[touch_].from_frame;
}

void FingerModel::move(std::int64_t frame) {
  const double period_s = 2 * (finger_.stroke_s + finger_.pause_s);
  const double t =
      std::fmod(static_cast<double>(frame - finger_.touches[touch_].from_frame) / rate_Hz_, period_s);
  const double length_m = finger_.to_m - finger_.from_m;
  const bool back = t >= period_s / 2;
  // each half of the movement's period is a pause followed by a stroke
  const double share = ((back ? t - period_s / 2 : t) - finger_.pause_s) / finger_.stroke_s;
  const double out = minimum_jerk(share), speed = minimum_jerk_speed(share) / finger_.stroke_s;
  state_.finger_m = back ? finger_.to_m - length_m * out : finger_.from_m + length_m * out;
  state_.speed_m_s = (back ? -length_m : length_m) * speed;
}

const FingerState& FingerModel::step(std::int64_t frame, double relative_friction, bool lifted) {
  const double before_m = state_.finger_m;
  const bool touches = scheduled(frame);
  if (touches)
    move(frame);
  else
    state_.speed_m_s = 0;
  const double change = finger_.land_s > 0 ? step_s_ / finger_.land_s : 1;
  pressed_ = std::clamp(pressed_ + (touches && !lifted ? change : -change), 0.0, 1.0);

  const double normal = 1 + finger_.normal_noise * normal_noise_.next();
  const double roughness = 1 + finger_.friction_noise * friction_noise_.next();
  const double time_s = static_cast<double>(steps_++) * step_s_;
  state_.normal_N = finger_.normal_N * minimum_jerk(pressed_) * std::max(0.0, normal);
  state_.relative_friction += film_ * (relative_friction - state_.relative_friction);
  state_.friction = finger_.friction * std::exp(finger_.friction_drift_per_s * time_s) *
                    state_.relative_friction * std::max(0.0, roughness);

  const double limit_m = state_.friction * state_.normal_N / finger_.contact_N_per_m;
  stretch_m_ = std::clamp(stretch_m_ + state_.finger_m - before_m, -limit_m, limit_m);
  state_.lateral_N = finger_.contact_N_per_m * stretch_m_;
  state_.contact_m = state_.finger_m - stretch_m_;
  return state_;
}

}  // namespace turnpoint::simulation

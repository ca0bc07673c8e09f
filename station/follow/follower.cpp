#include "station/follow/follower.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "station/follow/need.hpp"

namespace turnpoint::follow {
namespace {

// A loop is saturated if it has been out of reach for 86 % of the last 0.2 s (first-order mean over 0.1 s),
// and no longer if for less than half.
constexpr double saturation_s = 0.1, saturated_share = 0.86, free_share = 0.5;
constexpr double reach_tolerance = 0.01;  // of relative friction

/// The nearest number that is not above the value.
float not_above(double value) {
  const auto near = static_cast<float>(value);
  return static_cast<double>(near) > value ? std::nextafter(near, 0.0f) : near;
}

}  // namespace

double until_rest_s(const Plan& plan) {
  const Timing& t = plan.timing;
  const double certain = std::max(plan.most_age_periods * t.period_frames, t.window_frames);
  return (certain + (t.buffer_periods + 1 + 1.0 / kGains) * t.period_frames) / t.rate_Hz + t.converter_s +
         plan.ramp_s;
}

Follower::Follower(const Plan& plan) : plan_(plan) {
  const Timing& timing = plan_.timing;
  need(timing.rate_Hz > 0 && timing.period_frames >= kGains && timing.period_frames % kGains == 0,
       "follower: the period must be a multiple of 8 frames");
  for (const double delay_s : {timing.cells_s, timing.converter_s, timing.film_s})
    need(std::isfinite(delay_s) && delay_s >= 0, "follower: a delay is below 0 or not known");
  need(timing.window_frames > 0 && timing.buffer_periods >= 0 && plan_.most_age_periods >= 1,
       "follower: window, buffer or most_age_periods");
  const Pattern& pattern = plan_.pattern;
  need(std::isfinite(pattern.base) && pattern.part_count >= 0 && pattern.part_count <= kMostParts,
       "follower: the pattern has no base, or more than 8 parts");
  need(plan_.resting_gain >= 0 && plan_.resting_gain <= plan_.map.most_gain(), "follower: resting gain");
  need(plan_.ramp_s > 0 && plan_.resume_s > 0 && std::isfinite(plan_.resume_s), "follower: ramps");
  need(plan_.envelope.most_gain == plan_.map.most_gain(),
       "follower: envelope and map must have the same limit of the gain");
  need(plan_.envelope.slew_per_s * plan_.ramp_s >= plan_.envelope.most_gain,
       "follower: the slew limit is too low for the ramp to the resting gain");
  const Delay delay = total_delay(timing);
  if (delay.refused()) throw std::invalid_argument("follower: " + sentence(delay));
  if (!(until_rest_s(plan_) <= kMostUntilRest_s))
    throw std::invalid_argument(fmt::format(
        "follower: {:.1f} ms from a fault to the resting gain, of them {:.1f} ms of ramp; allowed: {:.0f} ms",
        1e3 * until_rest_s(plan_), 1e3 * plan_.ramp_s, 1e3 * kMostUntilRest_s));
  period_s_ = static_cast<double>(timing.period_frames) / timing.rate_Hz;
  need(plan_.steady_s >= period_s_ && std::isfinite(plan_.steady_s), "follower: steady_s is below a period");
  lead_frames_ = (timing.cells_s + timing.film_s) * timing.rate_Hz;
  normal_age_frames_ = 0.5 * timing.window_frames + timing.buffer_periods * timing.period_frames +
                       timing.converter_s * timing.rate_Hz;
  plan_.envelope.step_s = period_s_ / kGains;
  plan_.estimator.rate_Hz = timing.rate_Hz;
  plan_.estimator.first_m = plan_.map.first_m();
  plan_.estimator.last_m = plan_.map.last_m();
  const double back_periods = (normal_age_frames_ + lead_frames_) / timing.period_frames;
  need(back_periods + plan_.most_age_periods + 2 <= kHistory,
       "follower: the delay is longer than 64 periods");
  if (plan_.control == Control::closed) {
    const double known_s = delay.horizon_s + 0.5 * period_s_;
    const LoopSettings& loop = plan_.loop;
    for (const double slope : {1 - loop.slope_share, 1 + loop.slope_share}) {
      const auto margins = loop_margins(loop.cutoff_Hz, known_s, known_s + loop.unknown_delay_s, slope);
      need(margins.stable && margins.most_amplified <= 1.01 * loop.most_amplified,
           "follower: the loop's cut-off is too high for the delay; see design_loop()");
    }
  }
  estimator_ = FingerEstimator(plan_.estimator);
  shaper_ = EnvelopeShaper(plan_.envelope, plan_.resting_gain);
  loop_ = FrictionLoop(plan_.loop, plan_.resting_friction, period_s_);
  history_.fill(1);
  wish_ = plan_.resting_gain;
}

Fault Follower::judge(std::int64_t output_frame, double newest_age_frames) noexcept {
  const Timing& timing = plan_.timing;
  const bool left_out = next_frame_ >= 0 && output_frame != next_frame_;
  const double age = static_cast<double>(output_frame) - static_cast<double>(newest_frame_);
  const bool too_new = newest_age_frames < normal_age_frames_ - timing.period_frames;
  if (left_out || too_new || newest_frame_ < 0 ||
      age > normal_age_frames_ + plan_.most_age_periods * timing.period_frames)
    return Fault::late;
  const Fault fault = estimator_.finger().fault;
  if (fault != Fault::none) return fault;
  return saturation_ ? Fault::saturated : Fault::none;
}

double Follower::wish_at(double place_m, double time_s, double& asked, bool& reachable) const noexcept {
  asked = asked_at(plan_.pattern, state_, place_m, time_s);
  if (plan_.pattern.asked == Asked::displacement) {
    reachable = asked >= 0 && asked <= plan_.map.most_displacement_m(place_m);
    return plan_.map.gain_for_displacement(place_m, asked);
  }
  const double resting = plan_.control == Control::closed ? loop_.resting_friction() : plan_.resting_friction;
  const double relative = asked / resting;
  reachable =
      relative >= plan_.map.lowest_friction(place_m) - reach_tolerance && relative <= 1 + reach_tolerance;
  return plan_.map.gain(place_m, relative);
}

double Follower::modelled_at(double frame) const noexcept {
  // period k (counted from the first) has its middle at first + (k + 1/2) periods
  const double at = (frame - static_cast<double>(first_frame_)) / plan_.timing.period_frames - 0.5;
  const double newest = static_cast<double>(periods_ - 1);
  const double k = std::clamp(at, std::max(0.0, newest - (kHistory - 2)), std::max(0.0, newest));
  const auto i = static_cast<std::int64_t>(k);
  const auto value = [&](std::int64_t period) {
    return static_cast<double>(history_[static_cast<std::size_t>(std::min(period, periods_ - 1) % kHistory)]);
  };
  if (periods_ == 0) return 1;
  return value(i) + (k - static_cast<double>(i)) * (value(i + 1) - value(i));
}

void Follower::learn(const FingerSample& newest) noexcept {
  const Finger& finger = estimator_.finger();
  const LoopMeasurement measured{finger.normal_N, finger.lateral_N, finger.speed_m_s, finger.travelled_m,
                                 modelled_at(static_cast<double>(newest.frame) - lead_frames_)};
  update_.felt = std::numeric_limits<double>::quiet_NaN();
  if (finger.fault != Fault::none) return;
  update_.felt = loop_.friction(measured);
  loop_.learn(measured);
}

void Follower::name_interruption(Fault fault) noexcept {
  if (fault == Fault::none) return;
  update_.seen |= 1u << static_cast<unsigned>(fault);
  // A finger that leaves is too light to tell its place at first.
  const bool leaves = interruption_ == Fault::position && too_light_ && fault == Fault::lifted;
  if ((following_ > 0 && interruption_ == Fault::none) || leaves) {
    interruption_ = fault;
    too_light_ = estimator_.finger().normal_N < plan_.estimator.least_normal_N;
  }
  update_.interrupted = earlier_;
  if (interruption_ != Fault::none) update_.interrupted |= 1u << static_cast<unsigned>(interruption_);
}

const Update& Follower::update(std::int64_t output_frame, const FingerSample& newest) noexcept {
  const Timing& timing = plan_.timing;
  if (start_frame_ < 0) start_frame_ = first_frame_ = output_frame;
  // A sample from the future is not taken: those that follow would then be older than it.
  const double age = static_cast<double>(output_frame) - static_cast<double>(newest.frame);
  if (newest.frame > newest_frame_ && age >= normal_age_frames_ - timing.period_frames) {
    estimator_.push(newest);
    learn(newest);
    newest_frame_ = newest.frame;
  }
  const Fault fault = judge(output_frame, age);
  if (next_frame_ >= 0 && output_frame != next_frame_) first_frame_ += output_frame - next_frame_;
  next_frame_ = output_frame + timing.period_frames;
  name_interruption(fault);
  update_.fault = fault;

  const Finger& finger = estimator_.finger();
  const double lead = lead_frames_, step_frames = static_cast<double>(timing.period_frames) / kGains;
  const double start_s = static_cast<double>(output_frame - start_frame_) / timing.rate_Hz;
  const bool placed = finger.fault == Fault::none && fault != Fault::late;
  const auto frame_of = [&](double step) { return static_cast<double>(output_frame) + step * step_frames; };
  update_.speed_m_s = placed ? finger.speed_m_s : 0;
  // While the finger slides, the stretch of its skin is that of the asked friction; otherwise it is as
  // measured.
  const double skin = plan_.estimator.skin_m_per_N;
  const bool slides = loop_.slides(finger.normal_N, finger.speed_m_s, finger.travelled_m) &&
                      plan_.pattern.asked == Asked::friction && following_ > 0.5;
  const double pull_N = std::copysign(finger.normal_N, finger.speed_m_s);
  const double stretch_m = slides ? skin * pull_N * asked_ : skin * finger.lateral_N;
  const double middle_m =
      placed ? estimator_.place_at(frame_of(0.5 * kGains) + lead) - stretch_m : update_.place_m;
  // While the force is not known, nobody knows whether the finger has lifted.
  const bool force_known =
      finger.fault != Fault::reference && finger.fault != Fault::force && fault != Fault::late;
  if (force_known)
    note(plan_.pattern, state_, {start_s, middle_m, update_.speed_m_s, finger.normal_N, finger.contact});

  // An interruption leads to the resting gain, however short the fault is.
  const bool interrupted = fault != Fault::none || (interruption_ != Fault::none && following_ > 0);
  steady_s_ = interrupted ? 0 : steady_s_ + period_s_;
  if (steady_s_ >= plan_.steady_s) earlier_ = update_.interrupted, interruption_ = Fault::none;
  // The ramp after a fault begins at the gain of that moment, and always takes ramp_s.
  if (!interrupted) leaving_ = false;
  if (interrupted && !leaving_) leaving_ = true, leave_share_ = following_, leave_gain_ = shaper_.gain();
  const double change = interrupted                   ? -leave_share_ * period_s_ / kGains / plan_.ramp_s
                        : steady_s_ >= plan_.steady_s ? period_s_ / kGains / plan_.resume_s
                                                      : 0;
  // wishes from one step before the first gain to one step after the last
  std::array<double, kGains + 2> wish{}, share{};
  double following = following_;
  for (std::size_t k = 0; k < wish.size(); ++k) {
    const auto step = static_cast<double>(k);
    if (placed) {
      double asked = 0;
      bool reachable = true;
      const double place = estimator_.place_at(frame_of(step) + lead) - stretch_m;
      wish_ = wish_at(place, start_s + step * period_s_ / kGains, asked, reachable);
      // what can be felt of it
      if (k < kGains) {
        const double resting =
            plan_.control == Control::closed ? loop_.resting_friction() : plan_.resting_friction;
        asked_ = resting * std::clamp(asked / resting, plan_.map.lowest_friction(place), 1.0);
      }
      if (k == kGains / 2) update_.asked = asked, update_.reachable = reachable;
    }
    share[k] = std::clamp(following_ + change * step, 0.0, 1.0);
    if (!std::isfinite(wish_)) wish_ = plan_.resting_gain;
    if (k <= kGains) following = share[k];
    wish[k] = plan_.resting_gain + share[k] * (wish_ - plan_.resting_gain);
  }
  following_ = following;
  update_.following = static_cast<float>(following_);
  update_.place_m = middle_m;

  for (std::size_t k = 0; k < kGains; ++k) {
    // Without following, and on the way there, the gain itself goes in a straight line: the inverse of a slow
    // plate would swing around the resting gain.
    double gain = 0;
    if (leaving_ || following_ <= 0) {
      const double left = leave_share_ > 0 ? share[k + 1] / leave_share_ : 0;
      gain = shaper_.put(plan_.resting_gain + left * (leave_gain_ - plan_.resting_gain));
    } else {
      gain = shaper_.next(wish[k], wish[k + 1], wish[k + 2]);
    }
    update_.gain[k] = not_above(gain);
    if (k == kGains / 2 - 1) {
      const double relative = plan_.map.relative_friction(middle_m, shaper_.amplitude());
      history_[static_cast<std::size_t>(periods_ % kHistory)] = static_cast<float>(relative);
      update_.resting_friction =
          plan_.control == Control::closed ? loop_.resting_friction() : plan_.resting_friction;
      update_.modelled = relative * update_.resting_friction;
    }
  }
  ++periods_;

  if (plan_.control == Control::closed && plan_.pattern.asked == Asked::friction && placed) {
    // More than the friction at rest is not counted: there the best answer is no drive, and it is given.
    const bool too_little = !update_.reachable && update_.asked < update_.resting_friction;
    saturated_ += period_s_ / saturation_s * ((too_little ? 1.0 : 0.0) - saturated_);
    if (saturated_ > saturated_share) saturation_ = true;
    if (saturated_ < free_share) saturation_ = false;
  }
  return update_;
}

}  // namespace turnpoint::follow

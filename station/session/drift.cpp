#include "station/session/drift.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "physics/centre_line.hpp"
#include "station/core/number.hpp"
#include "station/session/capture_feed.hpp"
#include "station/system/thermometer.hpp"

namespace turnpoint::session {

namespace {

constexpr double kFlag_K = 3;
constexpr double kCorrect_m = 0.2e-3;
// A drift of 1 % would need a temperature change of 40 K. A larger drift means damage, which must not be
// corrected: the vibration proof has to report it.
constexpr double kMostDrift = 0.01;

}  // namespace

double boundary_shift_m(const physics::Surface& surface, double frequency_Hz, double share) {
  const auto then = physics::turning_point_m(surface, frequency_Hz);
  const auto now = physics::turning_point_m(surface, frequency_Hz / (1 + share));
  return then && now ? *now - *then : 0;
}

Drift::Drift(const Setup& setup, Stage& stage, store::SessionLog& log)
    : setup_(setup), stage_(stage), log_(log) {
  auto capture = stage_.capture();
  if (!capture)
    if (const auto card = card_capture_of(setup_.rig)) capture = card->setup;
  if (capture && !capture->pick_ups.empty()) tracker_.emplace(capture->pick_ups);
  if (!setup_.rig.thermometers) return;
  thermometers_ = {system::find_thermometer(setup_.rig.thermometers->plate_uri, setup_.thermometers),
                   system::find_thermometer(setup_.rig.thermometers->frame_uri, setup_.thermometers)};
}

void Drift::log_temperature(int trial_index) {
  if (thermometers_.empty()) return;
  const auto plate = system::read_thermometer_C(thermometers_[0]);
  const auto frame = system::read_thermometer_C(thermometers_[1]);
  const auto shown = [](const std::optional<double>& value) {
    return value ? core::number(*value, 4) : std::string("unknown");
  };
  log_.event({stage_.now_ns(), "temperature", "plate " + shown(plate) + " C, frame " + shown(frame) + " C",
              trial_index});
  const std::array now{plate, frame};
  for (std::size_t k = 0; k < now.size(); ++k) {
    if (!now[k]) continue;
    if (!first_C_[k]) first_C_[k] = now[k];
    const double change_K = *now[k] - *first_C_[k];
    if (std::abs(change_K) < kFlag_K || warm_[k]) continue;
    warm_[k] = true;
    log_.event({stage_.now_ns(), "temperature_flag",
                fmt::format("the {} changed by {} K since the session began", k == 0 ? "plate" : "frame",
                            core::number(change_K, 3)),
                trial_index});
  }
}

void Drift::follow(const sensing::IntervalResult& measured) {
  using core::Proof;
  if (!tracker_ || (measured.verdict != Proof::ok && measured.verdict != Proof::flagged)) return;
  if (const auto found = tracker_->take(measured.tones, applied_)) newest_ = found;
}

std::optional<double> Drift::correction(int trial_index) {
  const auto found = std::exchange(newest_, std::nullopt);
  if (!found) return std::nullopt;
  const auto& drift = *found;
  double largest_m = 0;
  const auto surface = rig::surface_of(setup_.rig);
  for (const auto& transducer : setup_.rig.transducers)
    for (const double f :
         {transducer.low_Hz, std::sqrt(transducer.low_Hz * transducer.high_Hz), transducer.high_Hz})
      if (const double shift_m = boundary_shift_m(surface, f, (1 + drift.share) / (1 + applied_) - 1);
          std::abs(shift_m) > std::abs(largest_m))
        largest_m = shift_m;
  if (std::abs(largest_m) < kCorrect_m || std::abs(drift.share) > kMostDrift) return std::nullopt;
  applied_ = drift.share;
  log_.event(
      {stage_.now_ns(), "drift",
       fmt::format("the resonances moved by {} % since the calibration, boundaries by up to {} mm since "
                   "the last correction; frequencies are corrected",
                   core::number(100 * drift.share, 3), core::number(1e3 * largest_m, 3)),
       trial_index});
  return applied_;
}

}  // namespace turnpoint::session

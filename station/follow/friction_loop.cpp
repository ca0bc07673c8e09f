#include "station/follow/friction_loop.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace turnpoint::follow {
namespace {

// A measurement this far from the model moves the estimate no further than one at this distance, so that a
// single wrong sample cannot throw it off.
constexpr double most_surprise = 1.5;
constexpr double least_ratio = 0.02;  // less than this is no sliding finger

LoopMargins worse(const LoopMargins& a, const LoopMargins& b) {
  const LoopMargins& peak = a.most_amplified > b.most_amplified ? a : b;
  return {a.stable && b.stable, peak.most_amplified, peak.at_Hz, std::min(a.reduced_1_Hz, b.reduced_1_Hz),
          std::min(a.reduced_3_Hz, b.reduced_3_Hz)};
}

}  // namespace

LoopMargins loop_margins(double cutoff_Hz, double model_delay_s, double delay_s, double gain_ratio) {
  using Complex = std::complex<double>;
  const auto filter = [&](double f) { return 1.0 / Complex(1, f / cutoff_Hz); };
  const auto late = [](double f, double by_s) { return std::polar(1.0, -2 * std::numbers::pi * f * by_s); };
  const auto characteristic = [&](double f) {
    return 1.0 - filter(f) * late(f, model_delay_s) + gain_ratio * filter(f) * late(f, delay_s);
  };
  const auto remains = [&](double f) {
    return std::abs((1.0 - filter(f) * late(f, model_delay_s)) / characteristic(f));
  };
  LoopMargins margins;
  margins.reduced_1_Hz = 1 / remains(1);
  margins.reduced_3_Hz = 1 / remains(3);
  // The characteristic has no poles to the right of the imaginary axis, so it has no zeros there either if it
  // does not turn about 0 between frequency 0 and where the filter has become negligible.
  double turned = 0, last = 0;
  for (double f = 0; f < 100 * cutoff_Hz; f += 0.05 * cutoff_Hz) {
    const double angle = std::arg(characteristic(f));
    if (f > 0) turned += std::remainder(angle - last, 2 * std::numbers::pi);
    last = angle;
    if (f > 0 && remains(f) > margins.most_amplified) margins.most_amplified = remains(f), margins.at_Hz = f;
  }
  margins.stable = std::abs(turned) < std::numbers::pi;
  return margins;
}

LoopDesign design_loop(const LoopUncertainty& u) {
  LoopDesign best;
  for (double cutoff = 0.25; cutoff <= 20; cutoff += 0.25) {
    LoopDesign design{cutoff, loop_margins(cutoff, u.model_delay_s, u.model_delay_s, 1), {}};
    design.worst = design.nominal;
    for (const double added : {0.0, 0.5 * u.added_delay_s, u.added_delay_s})
      for (const double gain : {1 - u.gain_share, 1.0, 1 + u.gain_share})
        design.worst =
            worse(design.worst, loop_margins(cutoff, u.model_delay_s, u.model_delay_s + added, gain));
    if (!design.worst.stable || design.worst.most_amplified > u.most_amplified) break;
    best = design;
  }
  return best;
}

FrictionLoop::FrictionLoop(const LoopSettings& settings, double resting_friction, double period_s)
    : settings_(settings) {
  if (!(resting_friction >= settings.lowest && resting_friction <= settings.highest))
    throw std::invalid_argument("loop: the friction of the surface at rest is outside its limits");
  for (const double value : {settings.cutoff_Hz, settings.least_normal_N, settings.least_speed_m_s,
                             settings.lowest, settings.highest, period_s})
    if (!(std::isfinite(value) && value > 0)) throw std::invalid_argument("loop: a value is not above 0");
  if (!(settings.settle_m >= 0)) throw std::invalid_argument("loop: settle_m is below 0");
  take_ = 1 - std::exp(-2 * std::numbers::pi * settings.cutoff_Hz * period_s);
  log_resting_ = std::log(resting_friction);
  resting_ = resting_friction;
}

double FrictionLoop::friction(const LoopMeasurement& m) const noexcept {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!slides(m.normal_N, m.speed_m_s, m.travelled_m)) return none;
  const double ratio = (m.speed_m_s > 0 ? m.lateral_N : -m.lateral_N) / m.normal_N;
  return ratio >= least_ratio ? ratio : none;
}

void FrictionLoop::learn(const LoopMeasurement& m) noexcept {
  const double ratio = friction(m);
  if (!std::isfinite(ratio) || !(m.modelled > 0)) return;
  const double surprise = std::log(ratio / m.modelled) - log_resting_;
  log_resting_ += take_ * std::clamp(surprise, -most_surprise, most_surprise);
  log_resting_ = std::clamp(log_resting_, std::log(settings_.lowest), std::log(settings_.highest));
  resting_ = std::exp(log_resting_);
}

}  // namespace turnpoint::follow

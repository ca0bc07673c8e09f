#include "station/follow/envelope.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace turnpoint::follow {
namespace {

constexpr double catch_up_steps = 2.5, most_steps = 200000;

}  // namespace

double envelope_time_constant_s(double quality, double frequency_Hz) {
  return quality / (std::numbers::pi * frequency_Hz);
}

EnvelopeShaper::EnvelopeShaper(const Envelope& e, double start)
    : envelope_(e), start_(start), gain_(start), amplitude_(start) {
  for (const double value : {e.time_constant_s, e.most_gain, e.slew_per_s, e.step_s})
    if (!(std::isfinite(value) && value > 0)) throw std::invalid_argument("envelope: a value is not above 0");
  if (!(start >= 0 && start <= e.most_gain)) throw std::invalid_argument("envelope: the gain at the start");
  // the exact response of the plate to a straight line from the last gain to this one
  const double h = e.step_s / e.time_constant_s;
  keep_ = std::exp(-h);
  from_this_ = 1 - (1 - keep_) / h;
  from_last_ = (1 - keep_) / h - keep_;
  // A gain that needs longer than this to come back would overshoot again and again.
  const double catch_up_s = std::max(catch_up_steps * e.step_s, e.most_gain / e.slew_per_s);
  catch_up_ = std::max(0.0, e.time_constant_s / catch_up_s - 1);
}

double EnvelopeShaper::next(double before, double now, double after) noexcept {
  const Envelope& e = envelope_;
  const double rest = keep_ * amplitude_ + from_last_ * gain_;  // the amplitude without this gain
  const double slope = (after - before) / (2 * e.step_s);
  double wish = (now + e.time_constant_s * slope + catch_up_ * (now - rest)) / (1 + catch_up_ * from_this_);
  return put(std::isfinite(wish) ? wish : start_);
}

double EnvelopeShaper::put(double wish) noexcept {
  const Envelope& e = envelope_;
  const double rest = keep_ * amplitude_ + from_last_ * gain_;
  const double change = e.slew_per_s * e.step_s;
  gain_ = std::clamp(std::clamp(wish, gain_ - change, gain_ + change), 0.0, e.most_gain);
  amplitude_ = rest + from_this_ * gain_;
  return gain_;
}

double bandwidth_Hz(const Envelope& e, double mean, double swing) {
  if (swing <= 0) return std::numeric_limits<double>::infinity();
  const double room = std::min(mean, e.most_gain - mean) / swing;
  if (!(room >= 1)) return 0;
  const double by_limit = std::sqrt(room * room - 1) / e.time_constant_s;
  // slew: swing w sqrt(1 + (w T)^2) = slew
  const double s = e.slew_per_s / swing, t2 = e.time_constant_s * e.time_constant_s;
  const double by_slew = std::sqrt((std::sqrt(1 + 4 * t2 * s * s) - 1) / (2 * t2));
  return std::min(by_limit, by_slew) / (2 * std::numbers::pi);
}

Presented presented(const Pattern& below, const Part& texture, const GainMap& map, const Envelope& limits,
                    double period_s, double resting_friction, double place_m, double speed_m_s) {
  const bool waves = texture.shape == Shape::sine || texture.shape == Shape::square ||
                     texture.shape == Shape::triangle || texture.shape == Shape::table;
  // cycles per second under the finger
  const double cycles_per_s = texture.cycles_per_m * speed_m_s + texture.cycles_per_s;
  const double frequency = std::abs(cycles_per_s);
  Envelope envelope = limits;
  envelope.step_s = period_s / kGains;
  if (limits.most_gain != map.most_gain()) throw std::invalid_argument("presented: two limits of the gain");
  if (!waves || !(frequency * most_steps * envelope.step_s >= 1))
    throw std::invalid_argument("presented: needs a texture that varies under the finger");
  Pattern alone = below;
  alone.base = asked_at(below, {}, place_m, 0);
  alone.part_count = 1;
  alone.parts[0] = texture;
  alone.parts[0].trigger = {};
  alone.parts[0].begin_m = -std::numeric_limits<double>::infinity();
  alone.parts[0].end_m = std::numeric_limits<double>::infinity();
  alone.parts[0].cycles_per_s = cycles_per_s;  // passes under a finger that stays
  alone.parts[0].cycles_per_m = 0;
  const bool friction = below.asked == Asked::friction;
  const double most_m = map.most_displacement_m(place_m);
  const auto wish = [&](double time_s) {
    const double asked = asked_at(alone, {}, place_m, time_s);
    return friction ? map.gain(place_m, asked / resting_friction) : map.gain_for_displacement(place_m, asked);
  };
  const auto felt_at = [&](double amplitude) {
    return friction ? resting_friction * map.relative_friction(place_m, amplitude)
                    : amplitude / map.most_gain() * most_m;
  };

  Presented result;
  result.frequency_Hz = frequency;
  const double step = envelope.step_s, per_cycle = 1 / (frequency * step);
  const int warm = static_cast<int>(
      std::min(most_steps, std::ceil(std::max(per_cycle, 8 * envelope.time_constant_s / step))));
  const int count = static_cast<int>(
      std::lround((per_cycle > 1e4 ? 1 : std::max(4.0, std::ceil(200 / per_cycle))) * per_cycle));
  EnvelopeShaper shaper(envelope);
  std::complex<double> asked_1, felt_1;
  double asked_mean = 0, square = 0, miss = 0;
  std::vector<double> asked, felt;
  for (int k = -warm; k < count; ++k) {
    const double time = k * step, last = shaper.gain();
    shaper.next(wish(time - step), wish(time), wish(time + step));
    if (k < 0) continue;
    const double change = std::abs(shaper.gain() - last);
    if (shaper.gain() <= 0 || shaper.gain() >= envelope.most_gain ||
        change >= 0.999 * envelope.slew_per_s * step)
      result.limited += 1.0 / count;
    asked.push_back(asked_at(alone, {}, place_m, time));
    felt.push_back(felt_at(shaper.amplitude()));
    const auto turn = std::polar(1.0, -2 * std::numbers::pi * frequency * time);
    asked_1 += asked.back() * turn, felt_1 += felt.back() * turn;
    asked_mean += asked.back() / count;
  }
  for (std::size_t i = 0; i < asked.size(); ++i) {
    square += (asked[i] - asked_mean) * (asked[i] - asked_mean);
    miss += (felt[i] - asked[i]) * (felt[i] - asked[i]);
  }
  result.amplitude_ratio = std::abs(felt_1) / std::abs(asked_1);
  result.phase_cycles = -std::arg(felt_1 / asked_1) / (2 * std::numbers::pi);
  result.residual = std::sqrt(miss / square);
  result.presentable = std::abs(result.amplitude_ratio - 1) <= 0.1 && std::abs(result.phase_cycles) <= 0.05 &&
                       per_cycle >= 8 && (texture.shape == Shape::square || result.residual < 0.15);
  return result;
}

}  // namespace turnpoint::follow

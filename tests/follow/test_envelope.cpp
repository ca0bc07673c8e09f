#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "station/follow/envelope.hpp"
#include "tests/follow/tables.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::follow;

namespace {

/// The plate's amplitude after each step: tau a' = g - a in 200 small steps, with straight lines of the gain.
struct Plate {
  double tau_s, amplitude = 0, last = 0;
  double step(double gain, double step_s) {
    for (int i = 0; i < 200; ++i) {
      const double g = last + (gain - last) * (i + 0.5) / 200;
      amplitude += step_s / 200 / tau_s * (g - amplitude);
    }
    last = gain;
    return amplitude;
  }
};

struct Wave {
  double ratio, phase_cycles, residual;
};
/// What becomes of mean + swing sin(2 pi f t) behind a plate with another time constant than the shaper
/// knows.
Wave through(const Envelope& envelope, double plate_tau_s, double frequency, double mean, double swing) {
  EnvelopeShaper shaper(envelope);
  Plate plate{plate_tau_s};
  const auto wish = [&](double t) { return mean + swing * std::sin(2 * std::numbers::pi * frequency * t); };
  const int per_cycle = static_cast<int>(std::lround(1 / (frequency * envelope.step_s)));
  std::complex<double> first;
  double miss = 0;
  const int warm = static_cast<int>(std::ceil(0.05 / envelope.step_s / per_cycle)) * per_cycle;
  for (int k = 1; k <= warm + 4 * per_cycle; ++k) {
    const double h = envelope.step_s, t = k * h;
    const double a = plate.step(shaper.next(wish(t - h), wish(t), wish(t + h)), h);
    if (k <= warm) continue;
    first += a * std::polar(1.0, -2 * std::numbers::pi * frequency * t) * 2.0 / (4.0 * per_cycle);
    miss += (a - wish(t)) * (a - wish(t)) / (4.0 * per_cycle);
  }
  const auto z = first * std::complex<double>(0, 1);
  return {std::abs(z) / swing, -std::arg(z) / (2 * std::numbers::pi), std::sqrt(2 * miss) / swing};
}

}  // namespace

TEST_CASE("the shaped gain makes the envelope follow, where it alone would not", "[envelope]") {
  Envelope e;
  e.time_constant_s = envelope_time_constant_s(60, 30000);
  CHECK(e.time_constant_s == Approx(0.6366e-3).epsilon(1e-3));
  for (const double f : {20.0, 50.0, 100.0, 200.0}) {
    const auto wave = through(e, e.time_constant_s, f, 0.5, 0.2);
    CAPTURE(f, wave.ratio, wave.phase_cycles);
    CHECK(wave.ratio == Approx(1).margin(0.02));
    CHECK(std::abs(wave.phase_cycles) < 0.005);
    CHECK(wave.residual < 0.02);
  }
  // without the shaper, 200 Hz would lag by 39 degrees
  CHECK(std::atan(2 * std::numbers::pi * 200 * e.time_constant_s) > 0.67);
  // a Q that is 15 % off costs a few per cent
  for (const double off : {0.85, 1.15}) {
    const auto wave = through(e, off * e.time_constant_s, 50, 0.5, 0.2);
    CHECK(wave.ratio == Approx(1).margin(0.05));
    CHECK(std::abs(wave.phase_cycles) < 0.01);
  }
}

TEST_CASE("the gain stays within its limit and its slew, and catches up after a limit", "[envelope]") {
  Envelope e;
  e.time_constant_s = envelope_time_constant_s(500, 30000);  // 5.3 ms
  e.most_gain = 0.9, e.slew_per_s = 3000;
  EnvelopeShaper shaper(e);
  Plate plate{e.time_constant_s};
  double last = 0, rise_s = 0, settled = 0;
  for (int k = 0; k < 800; ++k) {
    const auto wish = [](int i) { return i < 400 ? 0.5 : 0.1; };
    const double gain = shaper.next(wish(k - 1), wish(k), wish(k + 1));
    const double a = plate.step(gain, e.step_s);
    REQUIRE(gain >= 0);
    REQUIRE(gain <= 0.9);
    REQUIRE(std::abs(gain - last) <= 3000 * e.step_s * (1 + 1e-12));
    CHECK(shaper.amplitude() == Approx(a).margin(1e-3));
    if (rise_s == 0 && a > 0.45) rise_s = k * e.step_s;
    if (k == 398) settled = a;
    last = gain;
  }
  CHECK(rise_s < 4.5e-3);  // with 0.9 at the most; a step of the gain to 0.5 would take 12 ms
  CHECK(settled == Approx(0.5).margin(1e-3));
  CHECK(plate.amplitude == Approx(0.1).margin(1e-3));
}

TEST_CASE("the remaining bandwidth is where a limit begins to act", "[envelope]") {
  Envelope e;
  e.time_constant_s = 5.3e-3;
  e.slew_per_s = 1e6;
  const double f = bandwidth_Hz(e, 0.5, 0.1);
  CHECK(f == Approx(std::sqrt(24.0) / (2 * std::numbers::pi * 5.3e-3)));
  CHECK(through(e, e.time_constant_s, 0.9 * f, 0.5, 0.1).residual < 0.02);
  CHECK(through(e, e.time_constant_s, 1.3 * f, 0.5, 0.1).residual > 0.1);
  e.slew_per_s = 60;
  const double slow = bandwidth_Hz(e, 0.5, 0.1);
  CHECK(slow < f);
  CHECK(through(e, e.time_constant_s, 0.9 * slow, 0.5, 0.1).residual < 0.02);
  CHECK(through(e, e.time_constant_s, 1.6 * slow, 0.5, 0.1).residual > 0.1);
  CHECK(bandwidth_Hz(e, 0.5, 0.6) == 0);
  CHECK(std::isinf(bandwidth_Hz(e, 0.5, 0)));
}

TEST_CASE("a texture is presentable or not at a speed", "[envelope]") {
  plant::Setup s;
  const auto map = lab::map_of(s, lab::table_of(s));
  Pattern pattern;
  Part texture;
  texture.shape = Shape::sine, texture.from = 0.4, texture.to = 0.8, texture.cycles_per_m = 250;
  Envelope e;
  e.time_constant_s = envelope_time_constant_s(60, 30000);
  const auto good = presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 0.2);
  CAPTURE(good.amplitude_ratio, good.phase_cycles, good.residual);
  CHECK(good.frequency_Hz == Approx(50));
  CHECK(good.presentable);
  CHECK(good.residual < 0.05);
  e.time_constant_s = envelope_time_constant_s(500, 30000);
  const auto slow = presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 0.02);
  CHECK(slow.presentable);
  const auto fast = presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 0.4);
  CAPTURE(fast.amplitude_ratio, fast.phase_cycles, fast.residual, fast.limited);
  CHECK_FALSE(fast.presentable);
  CHECK(fast.limited > 0.2);
  e.time_constant_s = envelope_time_constant_s(60, 30000);
  texture.shape = Shape::square;
  CHECK(presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 0.1).presentable);
  texture.shape = Shape::sine, texture.cycles_per_m = 10000;  // 0.1 mm at 0.4 m/s: 4 kHz
  CHECK_FALSE(presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 0.4).presentable);
  // moving towards a finger that stays, or that moves: 50 Hz, and 50 + 200 Hz
  texture.cycles_per_m = 0, texture.cycles_per_s = 50;
  const auto standing = presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 0);
  CHECK(standing.frequency_Hz == Approx(50));
  CHECK(standing.amplitude_ratio == Approx(good.amplitude_ratio).epsilon(1e-6));
  texture.cycles_per_m = 250, texture.cycles_per_s = 200;
  CHECK(presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 0.2).frequency_Hz == Approx(250));
  CHECK(presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, -0.2).frequency_Hz == Approx(150));
  // added to what lies below it, it is what it is alone
  Part added = texture;
  added.cycles_per_s = 0, added.combine = Combine::add, added.from = -0.2, added.to = 0.2;
  Pattern below;
  below.base = 0.9;
  Part level;
  level.to = 0.6;
  add(below, level);
  const auto sum = presented(below, added, map, e, 0.5e-3, 1.0, 0.1, 0.2);
  CHECK(sum.presentable);
  CHECK(sum.amplitude_ratio == Approx(good.amplitude_ratio).epsilon(1e-6));
  // gains that are further apart follow 500 Hz worse
  texture.cycles_per_s = 0, texture.cycles_per_m = 2500;
  CHECK(presented(pattern, texture, map, e, 2e-3, 1.0, 0.1, 0.2).residual >
        presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 0.2).residual);
  texture.cycles_per_m = 250;
  CHECK_THROWS_AS(presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 1e-12), std::invalid_argument);
  CHECK_THROWS_AS(
      presented(pattern, texture, lab::map_of(s, lab::table_of(s), 0.5), e, 0.5e-3, 1.0, 0.1, 0.2),
      std::invalid_argument);
  texture.shape = Shape::edge;
  CHECK_THROWS_AS(presented(pattern, texture, map, e, 0.5e-3, 1.0, 0.1, 0.4), std::invalid_argument);
}

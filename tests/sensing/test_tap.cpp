#include "station/sensing/tap.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "tests/support/catch.hpp"

using namespace turnpoint::sensing;

namespace {

/// Three seconds of a force cell with noise. After one second, a mass on a spring (resonance and damping
/// ratio are given) is struck for 5 ms with 1 N.
std::vector<double> struck(double resonance_Hz, double damping, double rate_Hz, double noise_N = 0.25e-3,
                           double blow_N = 1) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  constexpr int steps = 64;  // steps of the simulation per point
  const double dt = 1 / (rate_Hz * steps), w = 2 * M_PI * resonance_Hz;
  double x = 0, v = 0;
  std::vector<double> points;
  for (int n = 0; n < 3 * rate_Hz; ++n) {
    for (int k = 0; k < steps; ++k) {
      const double t = (n + static_cast<double>(k) / steps) / rate_Hz;
      v += dt * w * w * ((t >= 1 && t < 1.005 ? blow_N : 0) - x - 2 * damping / w * v);
      x += dt * v;
    }
    points.push_back(0.01 + x + noise_N * normal(random));
  }
  return points;
}

}  // namespace

TEST_CASE("a tap shows the resonance to 3 %", "[sensing][tap]") {
  const double rate_Hz = GENERATE(480.0, 1000.0);
  const double damping = GENERATE(0.01, 0.05, 0.1);
  for (const double resonance_Hz : {30.0, 56.0, 60.0, 120.0, 180.0}) {
    CAPTURE(rate_Hz, damping, resonance_Hz);
    const auto found_Hz = ringing_Hz(struck(resonance_Hz, damping, rate_Hz), rate_Hz);
    REQUIRE(found_Hz);
    CHECK(*found_Hz == Approx(resonance_Hz).epsilon(0.03));
  }
}

TEST_CASE("without a tap, or if nothing rings, no resonance is stated", "[sensing][tap]") {
  CHECK_FALSE(ringing_Hz(struck(60, 0.05, 1000, 0.25e-3, 0), 1000));  // nobody taps
  CHECK_FALSE(ringing_Hz(struck(60, 2, 1000), 1000));                 // the plate sits in putty
  CHECK_FALSE(ringing_Hz(struck(60, 0.05, 1000, 0.2), 1000));         // the tap is lost in noise
  CHECK_FALSE(ringing_Hz(std::vector<double>(100, 0.5), 1000));       // too short
  auto late = struck(60, 0.05, 1000);
  late.resize(1100);  // the reading ends before the plate has rung
  CHECK_FALSE(ringing_Hz(late, 1000));
}

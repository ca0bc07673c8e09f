#include "physics/finger.hpp"

#include <cmath>

#include "physics/field.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

Surface foil() {
  Surface s = seed_brass();
  s.quality_factor = 60;
  return s;
}

}  // namespace

TEST_CASE("a finger of no impedance changes nothing, a heavy one stops the surface", "[physics]") {
  const std::vector<double> x{0.02, 0.1, 0.18, 0.21};
  for (const FingerLoad& load : finger_load(foil(), 19600, x, {0})) CHECK(load.loaded == load.unloaded);
  for (const FingerLoad& load : finger_load(foil(), 19600, x, {1e9})) {
    CHECK(std::abs(load.loaded) < 1e-3 * std::abs(load.unloaded));
  }
}

TEST_CASE("the unloaded response is the mode's field", "[physics]") {
  const std::vector<double> x{0.02, 0.1, 0.18, 0.21};
  const Tone tone{19600, 1, 0};
  const Field field = evaluate(foil(), {&tone, 1}, x, Model::mode, Normalise::drive);
  const auto loads = finger_load(foil(), 19600, x, Finger{});
  for (std::size_t i = 0; i < x.size(); ++i) {
    CHECK(std::abs(loads[i].unloaded - field.tones[0].v[i]) < 1e-12 * std::abs(field.tones[0].v[i]));
  }
}

TEST_CASE("on a lossy uniform strip the response to a force is that of two waves travelling away",
          "[physics]") {
  // With enough loss the ends do not matter: G = 1 / (2 i kx N W), and the strip offers 2 N W |kx| / omega.
  Surface s = foil();
  s.taper = LinearTaper{0.02, 0};
  s.length_m = 10;
  s.quality_factor = 30;
  const double f = 30e3, omega = 2 * M_PI * f;
  const std::complex<double> k = omega / wave_speed_m_s(s) * std::complex<double>(1, -0.5 / 30);
  const std::complex<double> kx = std::sqrt(k * k - std::pow(M_PI / 0.04, 2));
  const double expected = 2 * line_tension_N_per_m(s) * 0.02 * std::abs(kx) / omega;
  CHECK(finger_load(s, f, {5.0}, Finger{})[0].strip_impedance_Ns_per_m == Approx(expected).epsilon(1e-6));
}

TEST_CASE("a finger on the seed's foil takes most of the amplitude and moves the felt edge by millimetres",
          "[physics]") {
  const double peak = tone_info(foil(), 19600).last_peak_m.value();
  const FingerLoad load = finger_load(foil(), 19600, {peak}, Finger{})[0];
  CHECK(std::abs(load.loaded) < 0.4 * std::abs(load.unloaded));
  const auto shift = finger_edge_shift_m(foil(), 19600, Edge::percent(0.5), Finger{});
  REQUIRE(shift);
  CHECK(std::abs(*shift) > 3e-3);
  CHECK(std::abs(*shift) < 30e-3);
  CHECK(std::abs(finger_edge_shift_m(foil(), 19600, Edge::percent(0.5), {0.0}).value()) < 1e-9);
  CHECK_THROWS_AS(finger_load(aluminium_plate(), 30e3, {0.1}, Finger{}), std::domain_error);
}

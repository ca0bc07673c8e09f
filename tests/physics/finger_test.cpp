#include "physics/finger.hpp"

#include <cmath>

#include "physics/dispersion.hpp"
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
  // If waves decay before they reach the ends, the receptance is G = 1 / (2 i kx N W), and the strip's
  // impedance is 2 N W |kx| / omega.
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
}

TEST_CASE("on a lossy uniform clamped strip the response to a force is that of its own four waves",
          "[physics]") {
  // Kantorovich's equation with constant coefficients is m4 f_xxxx + 2 m2 f_xx + (m0 - k^4 m4) f = F/D delta.
  // In its solution two waves leave the force on each side. At the force the slope is 0 and the third
  // derivative jumps.
  Surface s = aluminium_plate();
  const double f = 30e3, w = 0.012, b = 2.365020372431352;
  s.taper = LinearTaper{w, 0};
  s.length_m = 3;
  s.quality_factor = 40;
  const auto integral = [&](auto part) {
    double sum = 0;
    constexpr int n = 4000;
    for (int i = 0; i < n; ++i) sum += part((i + 0.5) / n) * 2 * w / n;
    return sum;
  };
  const double unit = 1 / std::cos(b) - 1 / std::cosh(b);
  const auto phi = [&](double t) {
    return (std::cos(b * t) / std::cos(b) - std::cosh(b * t) / std::cosh(b)) / unit;
  };
  const auto slope = [&](double t) {
    return (-std::sin(b * t) / std::cos(b) - std::sinh(b * t) / std::cosh(b)) * b / w / unit;
  };
  const auto bend = [&](double t) {
    return (-std::cos(b * t) / std::cos(b) - std::cosh(b * t) / std::cosh(b)) * b * b / w / w / unit;
  };
  const double m4 = integral([&](double t) { return phi(t) * phi(t); });
  const double m2 = -integral([&](double t) { return slope(t) * slope(t); });
  const double m0 = integral([&](double t) { return bend(t) * bend(t); });
  const std::complex<double> k = wavenumber_per_m(s, f) * std::complex<double>(1, -0.5 / 40);
  const std::complex<double> root = std::sqrt(m2 * m2 / (m4 * m4) - m0 / m4 + k * k * k * k);
  std::complex<double> r1 = std::sqrt(-m2 / m4 + root), r2 = std::sqrt(-m2 / m4 - root);
  if (r1.real() < 0) r1 = -r1;
  if (r2.real() < 0) r2 = -r2;
  const std::complex<double> g =
      (1.0 / r2 - 1.0 / r1) / (2.0 * (r1 * r1 - r2 * r2)) / (m4 * bending_stiffness_N_m(s).value());
  const double expected = 1 / std::abs(2 * M_PI * f * g);
  // The polynomials of the elements smooth the jump of the third derivative under the force.
  CHECK(finger_load(s, f, {1.5}, Finger{})[0].strip_impedance_Ns_per_m == Approx(expected).epsilon(1e-3));
}

TEST_CASE("a clamped 2 mm plate keeps more of its amplitude under a finger than the foil", "[physics]") {
  const Surface plate = aluminium_plate();
  const double peak = tone_info(plate, 30e3).last_peak_m.value();
  const FingerLoad load = finger_load(plate, 30e3, {peak}, Finger{})[0];
  const double foil_peak = tone_info(foil(), 30e3).last_peak_m.value();
  const FingerLoad on_foil = finger_load(foil(), 30e3, {foil_peak}, Finger{})[0];
  CAPTURE(load.strip_impedance_Ns_per_m, on_foil.strip_impedance_Ns_per_m,
          std::abs(load.loaded / load.unloaded), std::abs(on_foil.loaded / on_foil.unloaded));
  CHECK(std::abs(load.loaded / load.unloaded) > 1.5 * std::abs(on_foil.loaded / on_foil.unloaded));
  CHECK(load.strip_impedance_Ns_per_m > 3 * on_foil.strip_impedance_Ns_per_m);
  for (const FingerLoad& light : finger_load(plate, 30e3, {0.02, peak, 0.25}, {0}))
    CHECK(light.loaded == light.unloaded);
  REQUIRE(finger_edge_shift_m(plate, 30e3, Edge::percent(0.5), Finger{}));
  CHECK(std::abs(*finger_edge_shift_m(plate, 30e3, Edge::percent(0.5), {0.0})) < 1e-9);
  Surface supported = plate;
  supported.edges = Edges::supported;
  CHECK_THROWS_AS(finger_load(supported, 30e3, {0.1}, Finger{}), std::domain_error);
}

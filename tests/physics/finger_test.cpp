#include "physics/finger.hpp"

#include <cmath>
#include <limits>

#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "tests/physics/csv_table.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;
using turnpoint::physics_test::oracle;

namespace {

Surface foil() {
  Surface s = seed_brass();
  s.quality_factor = 60;
  return s;
}

std::optional<double> edge_shift_m(const Surface& surface, double f, const Finger& finger) {
  return finger_edge_shift_m(finger_load(surface, f, finger_sweep_m(surface), {}), Edge::percent(0.5),
                             finger);
}

}  // namespace

TEST_CASE("a finger without impedance changes nothing, and a heavy finger stops the surface", "[physics]") {
  const std::vector<double> x{0.02, 0.1, 0.18, 0.21};
  for (const FingerLoad& load : finger_load(foil(), 19600, x, {0})) CHECK(load.loaded == load.unloaded);
  for (const FingerLoad& load : finger_load(foil(), 19600, x, {1e9})) {
    CHECK(std::abs(load.loaded) < 1e-3 * std::abs(load.unloaded));
  }
}

TEST_CASE("the motion of surfaces under a finger agrees with independent finite elements", "[physics]") {
  // The rows of finger.csv are places from the middle of the smooth zone to beyond its edge, on the centre
  // line and beside it. At each place, the fraction of the motion that remains under a finger is compared,
  // for fingers with real and with complex impedances.
  int compared = 0;
  double worst_share = 0, worst_unloaded = 0;
  for (const auto& row : oracle("finger.csv")) {
    Surface s = row[0] == "brass" ? foil() : aluminium_plate();
    if (row[0] == "mindlin") s.theory = PlateTheory::mindlin;
    const double f = std::stod(row[1]), x = std::stod(row[2]), beside = std::stod(row[3]);
    const std::complex<double> unloaded(std::stod(row[4]), std::stod(row[5]));
    const std::complex<double> mobility(std::stod(row[6]), std::stod(row[7]));
    const FingerLoad load = finger_load(s, f, {x}, Finger{{55, 0}, 4e-3, beside})[0];
    CAPTURE(row[0], f, x, beside, load.mobility_m_per_Ns, mobility);
    worst_unloaded = std::max(worst_unloaded, std::abs(load.unloaded / unloaded - 1.0));
    for (const double magnitude : {30.0, 55.0}) {
      for (const double phase : {-M_PI / 3, 0.0, M_PI / 4, M_PI / 3}) {
        const Finger finger{std::polar(magnitude, phase)};
        const double share = 1 / std::abs(1.0 + finger.impedance_Ns_per_m * mobility);
        CAPTURE(magnitude, phase, load.share(finger), share);
        worst_share = std::max(worst_share, std::abs(load.share(finger) / share - 1));
        CHECK(std::abs(load.share(finger) / share - 1) < finger_share_bound);
        ++compared;
      }
    }
  }
  CAPTURE(worst_share, worst_unloaded);
  CHECK(compared == 53 * 8);
  CHECK(worst_unloaded < 0.01);
}

TEST_CASE("on a uniform strip with loss, the response to a finger is a sum of the strip's waves",
          "[physics]") {
  // The response is a sum over modes n. Mode n spreads from a point in both directions as exp(-i kx |x|) over
  // 2 i kx, with kx^2 = k^2 - (n pi / 2W)^2. It is averaged over the finger's disc twice: for the force and
  // for the displacement. For a plate with simply supported sides, the same sum with -k^2 instead of k^2 (the
  // near fields of bending) is subtracted.
  const double w = 0.012, radius = 4e-3, f = 30e3, omega = 2 * M_PI * f;
  Surface s = aluminium_plate();
  s.edges = Edges::supported;
  s.length_m = 3;
  s.quality_factor = 40;
  const bool plate = GENERATE(true, false);
  if (!plate) {
    s = foil();
    s.length_m = 10;
    s.quality_factor = 30;
  }
  s.taper = LinearTaper{w, 0};
  const double k = wavenumber_per_m(s, f);
  const std::complex<double> lossy(1, (plate ? -0.25 : -0.5) / s.quality_factor);
  const auto waves = [&](std::complex<double> k2) {
    constexpr int steps = 400;
    std::complex<double> sum = 0;
    for (int n = 1; n < 240; n += 2) {
      const double across = n * M_PI / (2 * w);
      std::complex<double> ikx = std::sqrt(across * across - k2);
      if (ikx.real() < 0) ikx = -ikx;
      std::vector<double> mean;
      for (int i = 0; i < steps; ++i) {
        const double x = radius * (2 * (i + 0.5) / steps - 1);
        mean.push_back(2 * std::sin(across * std::sqrt(radius * radius - x * x)) / across /
                       (M_PI * radius * radius) * 2 * radius / steps);
      }
      for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j)
          sum += mean[static_cast<std::size_t>(i)] * mean[static_cast<std::size_t>(j)] *
                 std::exp(-ikx * (std::abs(i - j) * 2 * radius / steps)) / (2.0 * ikx * w);
    }
    return sum;
  };
  const std::complex<double> k2 = k * k * lossy * lossy;
  std::complex<double> receptance = waves(k2) / line_tension_N_per_m(s) * lossy * lossy;
  if (plate) {
    const double d = bending_stiffness_N_m(s).value();
    receptance = (waves(k2) - waves(-k2)) / (2.0 * k2 * d) * std::pow(lossy, 4);
  }
  const std::complex<double> i(0, 1);
  const FingerLoad load = finger_load(s, f, {s.length_m / 2}, Finger{})[0];
  CAPTURE(plate, load.mobility_m_per_Ns, i * omega * receptance);
  CHECK(std::abs(load.mobility_m_per_Ns / (i * omega * receptance) - 1.0) < 1e-2);
}

TEST_CASE("a finger on the brass foil removes most of the amplitude and moves the felt edge by millimetres",
          "[physics]") {
  const double peak = tone_info(foil(), 19600).last_peak_m.value();
  const FingerLoad load = finger_load(foil(), 19600, {peak}, Finger{})[0];
  CHECK(std::abs(load.loaded) < 0.4 * std::abs(load.unloaded));
  const auto shift = edge_shift_m(foil(), 19600, Finger{});
  REQUIRE(shift);
  CHECK(std::abs(*shift) > 3e-3);
  CHECK(std::abs(*shift) < 30e-3);
  CHECK(std::abs(edge_shift_m(foil(), 19600, {0.0}).value()) < 1e-9);
}

TEST_CASE("a clamped 2 mm plate keeps more of its amplitude under a finger than the foil", "[physics]") {
  const Surface plate = aluminium_plate();
  const double peak = tone_info(plate, 30e3).last_peak_m.value();
  const FingerLoad load = finger_load(plate, 30e3, {peak}, Finger{})[0];
  const double foil_peak = tone_info(foil(), 30e3).last_peak_m.value();
  const FingerLoad on_foil = finger_load(foil(), 30e3, {foil_peak}, Finger{})[0];
  CHECK(load.share(Finger{}) > 1.5 * on_foil.share(Finger{}));
  CHECK(std::abs(on_foil.mobility_m_per_Ns) > 3 * std::abs(load.mobility_m_per_Ns));
  CHECK(load.share(Finger{}) == Approx(std::abs(load.loaded / load.unloaded)));
  for (const FingerLoad& light : finger_load(plate, 30e3, {0, 0.02, peak, 0.25, 0.3}, {0}))
    CHECK(light.loaded == light.unloaded);
  REQUIRE(edge_shift_m(plate, 30e3, Finger{}));
  CHECK(std::abs(*edge_shift_m(plate, 30e3, {0.0})) < 1e-9);
}

TEST_CASE("the effect of a finger can be computed for every plate theory, taper and end of a strip",
          "[physics]") {
  Surface s = aluminium_plate();
  const std::vector<double> x{0, 1e-3, 0.05, 0.15, 0.298, 0.3};
  const auto shares = [&] {
    std::vector<double> all;
    for (const FingerLoad& load : finger_load(s, 30e3, x, Finger{})) {
      CHECK(std::isfinite(load.share(Finger{})));
      CHECK(std::isfinite(std::abs(load.loaded)));
      CHECK(load.mobility_m_per_Ns.real() >= -1e-12);  // negative would mean that the strip generates power
      all.push_back(load.share(Finger{}));
    }
    return all;
  };
  s.theory = PlateTheory::mindlin;
  const auto thick = shares();
  s.theory = PlateTheory::elastic;
  CHECK(shares() == thick);
  s.theory = PlateTheory::kirchhoff;
  for (const double q : {5.0, 1e6, std::numeric_limits<double>::infinity()}) {
    s.quality_factor = q;
    shares();
  }
  s.quality_factor = 60;
  s.taper = ExponentialTaper{0.014, 0.5};
  shares();
  s.taper = TabulatedTaper{{{0, 0.014}, {0.1, 0.012}, {0.3, 0.006}}};
  shares();
  s = foil();
  s.length_m = 0.3;  // the surface runs to its apex
  shares();
  CHECK_THROWS_AS(finger_load(s, 30e3, {0.31}, Finger{}), std::invalid_argument);
  CHECK_THROWS_AS(finger_load(s, 30e3, {0.1}, Finger{{55, 0}, 0}), std::invalid_argument);
}

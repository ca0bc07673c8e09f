#include "tests/simulation/lab.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::simulation;

TEST_CASE("the two cells carry the normal force, and their ratio shows where it is", "[plant]") {
  Cells cells;
  cells.first_m = 0.02;
  cells.span_m = 0.26;
  cells.height_m = 0.008;
  const auto [a, b, t] = forces_on(cells, {0.7, 0.35, 0.15});
  CHECK(a + b == Approx(0.7).epsilon(1e-14));
  CHECK(t == 0.35);
  // the centre of pressure is the force's position, moved by h T / N (height, lateral and normal force)
  CHECK(0.02 + 0.26 * b / (a + b) == Approx(0.15 + 0.008 * 0.35 / 0.7).epsilon(1e-14));
  const auto pulled_back = forces_on(cells, {0.7, -0.35, 0.15});
  CHECK(0.02 + 0.26 * pulled_back[1] / 0.7 == Approx(0.15 - 0.004).epsilon(1e-14));
}

TEST_CASE("a cell has the response of a second-order system", "[plant]") {
  const double f0 = 60, damping = 0.05;
  for (const double f : {6.0, 30.0, 60.0, 120.0, 400.0}) {
    Resonance resonance(f0, damping, kRate_Hz);
    // Wait 3 s, until the ringing has decayed below 1e-12, then sum over exactly 1 s.
    std::complex<double> sum = 0;
    for (std::int64_t n = 0; n < 4 * 192000; ++n) {
      const double y = resonance.step(cosine(f, n));
      if (n >= 3 * 192000)
        sum += y * std::polar(1.0, -2 * pi * std::fmod(f / kRate_Hz * static_cast<double>(n), 1.0));
    }
    const std::complex<double> z = 2.0 * sum / kRate_Hz;
    const double r = f / f0;
    const std::complex<double> closed = 1.0 / std::complex<double>(1 - r * r, 2 * damping * r);
    CAPTURE(f);
    CHECK(std::abs(z - closed) < 2e-4 * std::abs(closed));
  }
}

TEST_CASE("the lateral cell has its own resonance", "[plant]") {
  Cells cells = quiet_setup().cells;
  CellReadings readings(cells, kRate_Hz);
  // The first maximum after a step comes half a period later; with the damping d, the overshoot is exp(-pi d
  // / sqrt(1 - d^2)).
  double highest[3] = {}, at_s[3] = {};
  for (int n = 0; n < 3000; ++n) {
    const auto reading = readings.step({1, 1, 1}, 0);
    for (std::size_t c = 0; c < 3; ++c)
      if (reading[c] > highest[c]) highest[c] = reading[c], at_s[c] = (n + 0.5) / kRate_Hz;
  }
  const double damped = std::sqrt(1 - 0.05 * 0.05);
  const double overshoot = 1 + std::exp(-pi * 0.05 / damped);
  for (std::size_t c = 0; c < 3; ++c) CHECK(highest[c] == Approx(overshoot).epsilon(1e-4));
  CHECK(at_s[0] == Approx(0.5 / 60 / damped).epsilon(2e-3));
  CHECK(at_s[1] == Approx(0.5 / 60 / damped).epsilon(2e-3));
  CHECK(at_s[2] == Approx(0.5 / 180 / damped).epsilon(2e-3));
}

TEST_CASE("the readings of cells include crosstalk, a zero and a drift with temperature", "[plant]") {
  Cells cells;
  cells.crosstalk = {{{1, 0.02, -0.01}, {0.03, 1, 0.015}, {-0.02, 0.01, 1}}};
  cells.zero_N = {0.1, -0.2, 0.05};
  CellReadings readings(cells, kRate_Hz);
  CellForces last{};
  for (int n = 0; n < 4 * 192000; ++n) last = readings.step({0.5, 0.3, 0.2}, 4);
  CHECK(last[0] == Approx(0.5 + 0.02 * 0.3 - 0.01 * 0.2 + 0.1 + 0.004).epsilon(1e-9));
  CHECK(last[1] == Approx(0.03 * 0.5 + 0.3 + 0.015 * 0.2 - 0.2 + 0.004).epsilon(1e-9));
  CHECK(last[2] == Approx(-0.02 * 0.5 + 0.01 * 0.3 + 0.2 + 0.05 + 0.004).epsilon(1e-9));
}

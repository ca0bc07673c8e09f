#include "physics/figures.hpp"

#include <algorithm>
#include <cmath>

#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

TEST_CASE("the paper's four figures have their turning points and finite curves", "[physics]") {
  const auto all = figures();
  REQUIRE(all.size() == 4);
  CHECK(all[0].panels[0].marks[0].x_mm == Approx(198.654).margin(1e-3));
  CHECK(all[1].panels[1].marks[0].x_mm == Approx(250.340).margin(1e-3));
  CHECK(all[2].panels[0].marks[0].x_mm == Approx(150).margin(1e-6));
  CHECK(all[2].note.find("fitted") != std::string::npos);
  REQUIRE(all[3].panels.size() == 3);
  CHECK(all[3].panels[2].marks.size() == 2);
  for (const Figure& figure : all) {
    for (const FigurePanel& panel : figure.panels) {
      REQUIRE(panel.curves.size() == 3);
      for (const Curve& curve : panel.curves) {
        REQUIRE(curve.x_mm.size() == curve.value.size());
        CHECK(std::all_of(curve.value.begin(), curve.value.end(), [](double v) { return std::isfinite(v); }));
      }
    }
    const std::string csv = to_csv(figure);
    const auto points = static_cast<long>(figure.panels[0].curves[0].x_mm.size());
    CHECK(std::count(csv.begin(), csv.end(), '\n') == points + 1);
  }
}

TEST_CASE("relative to the last maximum, equation 11 is larger at the drive edge than the corrected mode",
          "[physics]") {
  const auto all = figures();
  const auto& panel = all[0].panels[0];
  const auto& seed = panel.curves[1].value;
  const auto& mode = panel.curves[0].value;
  double seed_first = 0, mode_first = 0;
  for (std::size_t i = 0; i < 200; ++i) {
    seed_first = std::max(seed_first, std::abs(seed[i]));
    mode_first = std::max(mode_first, std::abs(mode[i]));
  }
  // Relative to the last maximum, eq. 11 of the 1998 paper is larger at the drive edge than the mode, by the
  // factor sqrt(W0/W) = 1.7 (W0: half-width at the drive edge, W: at the last maximum).
  CHECK(seed_first / mode_first > 1.4);
  CHECK(seed_first / mode_first < 1.9);
}

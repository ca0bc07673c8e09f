#include "physics/figures.hpp"

#include <algorithm>
#include <cmath>

#include "tests/physics/csv_table.hpp"
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

TEST_CASE("the paper's curves have the last maxima that mpmath's Airy and Bessel functions have",
          "[physics]") {
  const auto all = figures();
  const auto peak_mm = [](const Curve& curve) {
    std::size_t i = curve.value.size() - 2;
    while (!(curve.value[i] > curve.value[i + 1] && curve.value[i] >= curve.value[i - 1])) --i;
    const double a = curve.value[i - 1], b = curve.value[i], c = curve.value[i + 1];
    return curve.x_mm[i] + 0.5 * (a - c) / (a - 2 * b + c) * (curve.x_mm[1] - curve.x_mm[0]);
  };
  const auto check = [&](const FigurePanel& panel, double airy_mm, double equation_mm) {
    CAPTURE(panel.title);
    CHECK(peak_mm(panel.curves[2]) == Approx(airy_mm).margin(6e-3));
    CHECK(peak_mm(panel.curves[1]) == Approx(equation_mm).margin(6e-3));
    for (const std::size_t i : {1u, 2u})
      CHECK(*std::max_element(panel.curves[i].value.end() - 600, panel.curves[i].value.end()) <= 1 + 1e-9);
  };
  check(all[0].panels[0], 185.59, 184.56);
  check(all[1].panels[0], 187.88, 186.87);
  check(all[1].panels[1], 243.94, 243.43);
  check(all[3].panels[0], 19.69, 17.17);
  check(all[3].panels[1], 250.17, 249.72);
  const auto rows = turnpoint::physics_test::oracle("paper.csv");
  REQUIRE(rows.size() == 30);
  for (const auto& row : rows) {
    const std::size_t figure = std::stoul(row[0]), panel = std::stoul(row[1]), at = std::stoul(row[2]);
    const auto& curves = all[figure].panels[panel].curves;
    CAPTURE(row[0], row[1], row[2]);
    CHECK(curves[1].value[at] == Approx(std::stod(row[3])).margin(1e-7));
    CHECK(curves[2].value[at] == Approx(std::stod(row[4])).margin(1e-7));
  }
}

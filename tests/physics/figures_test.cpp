#include "physics/figures.hpp"

#include <algorithm>
#include <cmath>

#include "physics/bench.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

TEST_CASE("the paper's four figures have their turning points and finite curves", "[physics]") {
  const auto all = figures();
  REQUIRE(all.size() == 4);
  CHECK(all[0].marks[0].x_mm == Approx(198.654).margin(1e-3));
  CHECK(all[1].marks[1].x_mm == Approx(250.340).margin(1e-3));
  CHECK(all[2].marks[0].x_mm == Approx(150).margin(1e-6));
  CHECK(all[2].note.find("fitted") != std::string::npos);
  CHECK(all[3].curves.size() == 5);
  for (const Figure& figure : all) {
    for (const Curve& curve : figure.curves) {
      REQUIRE(curve.x_mm.size() == curve.value.size());
      CHECK(std::all_of(curve.value.begin(), curve.value.end(), [](double v) { return std::isfinite(v); }));
    }
    const std::string csv = to_csv(figure);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == static_cast<long>(figure.curves[0].x_mm.size()) + 1);
  }
}

TEST_CASE("the bench measures every rung, and its errors fall up the ladder", "[physics]") {
  const auto rows = bench(0.01);
  const auto error = [&](const std::string& solver) {
    for (const BenchRow& row : rows) {
      if (row.scene == "seed brass 19.6 kHz, Q = 60" && row.solver == solver) return row.error;
    }
    return -1.0;
  };
  CHECK(error("airy") > error("seed"));
  CHECK(error("seed") > error("mode"));
  CHECK(error("mode") > 0);
  for (const BenchRow& row : rows) {
    CHECK(row.seconds > 0);
    // An independent solver of the same equation agrees with ours as far as its own order goes.
    if (row.against == "mode") CHECK(row.error < 1e-3);
  }
  CHECK(format(rows).find("mode") != std::string::npos);
}

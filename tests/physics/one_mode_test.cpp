#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "tests/physics/csv_table.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;
using turnpoint::physics_test::oracle;

namespace {

struct Case {
  Surface surface;
  bool equation_11;  // of the 1998 paper; else the equation of the model `mode`
  double frequency_Hz;
  struct Point {
    double x_m, ln, arg;
  };
  std::vector<Point> points;
};

Case parse(const std::vector<std::string>& row) {
  Case c;
  const auto number = [&](std::size_t i) { return std::stod(row[i]); };
  c.equation_11 = row[1] == "seed";
  c.surface = seed_brass();
  c.surface.density_kg_m3 = 1000;
  c.surface.tension_Pa = 640e6;  // this makes c exactly 800 m/s
  if (row[0] == "linear") {
    c.surface.taper = LinearTaper{number(3), number(2)};
  } else {
    c.surface.taper = ExponentialTaper{number(3), number(2)};
  }
  c.surface.length_m = number(4);
  c.frequency_Hz = number(5);
  c.surface.quality_factor = number(6) == 0 ? std::numeric_limits<double>::infinity() : number(6);
  for (std::size_t i = 7; i + 2 < row.size(); i += 3) {
    c.points.push_back({number(i) * c.surface.length_m, number(i + 1), number(i + 2)});
  }
  return c;
}

// Solves the equation of the model `mode` or, for comparison, equation 11 of the 1998 paper.
std::unique_ptr<CentreLine> solve(const Case& c, bool equation_11) {
  MarchEquation equation = march_equation(c.surface, c.frequency_Hz, Losses::kept);
  if (equation_11) equation.c = equation.w_power = 0;
  return make_marched_line(c.surface, equation);
}

}  // namespace

TEST_CASE(
    "the model mode and the 1998 paper's equation 11 match exact solutions for extreme tapers, losses and "
    "lengths",
    "[physics][oracle]") {
  const auto rows = oracle("one_mode.csv");
  REQUIRE(rows.size() == 830);
  double worst = 0, worst_evanescent = 0;
  for (const auto& row : rows) {
    const Case c = parse(row);
    CAPTURE(row[0], row[1], row[2], row[3], row[4], row[5], row[6]);
    const double k = wavenumber_per_m(c.surface, c.frequency_Hz);
    const auto line = solve(c, c.equation_11);
    constexpr double eps = std::numeric_limits<double>::epsilon();
    const Scaled v0 = line->value(0);
    const double cond = std::hypot(1.0, std::abs(line->slope(0).mantissa / v0.mantissa) / k);
    const double allowed = std::max(1e-12, 8 * eps * k * c.surface.length_m) * cond;
    std::vector<double> x;
    for (const auto& point : c.points) x.push_back(point.x_m);
    std::vector<std::complex<double>> v(x.size());
    std::vector<double> ln(x.size());
    line->evaluate(x, v0.mantissa / std::abs(v0.mantissa), v0.ln_magnitude(), v, ln);
    for (std::size_t i = 0; i < x.size(); ++i) {
      CAPTURE(x[i], c.points[i].ln, ln[i]);
      REQUIRE(std::isfinite(ln[i]));
      // The error is taken relative to the local envelope, because at a node of the standing wave the value
      // itself is 0.
      const Scaled here = line->value(x[i]);
      const double envelope = std::hypot(1.0, std::abs(line->slope(x[i]).mantissa / here.mantissa) / k);
      const double arg = std::arg(here.mantissa / v0.mantissa);
      const auto miss = std::polar(std::exp(ln[i] - c.points[i].ln), arg) - std::polar(1.0, c.points[i].arg);
      // The position has a rounding error. Where the field decays steeply, this causes an error of the value.
      const double scale = allowed * envelope + 4 * eps * c.surface.length_m * k * envelope;
      worst = std::max(worst, std::abs(miss) / scale);
      CHECK(std::abs(miss) <= scale);
      if (i >= 3) worst_evanescent = std::max(worst_evanescent, std::abs(ln[i] - c.points[i].ln) / cond);
    }
  }
  CHECK(worst_evanescent < 1e-10);
  CHECK(worst > 1e-4);  // negative control: the errors are not zero
}

TEST_CASE("the exact solutions of the two equations differ measurably", "[physics][oracle]") {
  // Negative control: eq. 11 of the 1998 paper differs from the table of the corrected equation by far more
  // than any tolerance of these tests.
  const Case c = parse(oracle("one_mode.csv")[401]);
  REQUIRE_FALSE(c.equation_11);
  const auto line = solve(c, true);
  const double ln = line->value(c.points[3].x_m).ln_magnitude() - line->value(0).ln_magnitude();
  CHECK(std::abs(ln - c.points[3].ln) > 1e-3);
}

#include "physics/boundary_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

#include "physics/boundary_budget.hpp"
#include "physics/edge_feature.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::physics;

namespace {

MapOptions edge(const char* text = "p50") {
  MapOptions options;
  options.edge = parse_edge(text);
  return options;
}

double solved_m(const Surface& s, double f, const MapOptions& options = edge()) {
  return solve_edge_m(s, options, f, Model::edge, Wave::exact).value();
}

Surface plate() {
  Surface s = aluminium_plate();
  s.sd.thickness_m = 0.02 * s.thickness_m;
  s.sd.clamp_line_m = 0.3e-3;
  s.sd.modulus_Pa = 0.015 * *s.modulus_Pa;
  return s;
}

Surface random_surface(Surface s, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const Surface nominal = s;
  for (const Parameter p : parameters(nominal))
    s = changed(s, p, standard_deviation(nominal, p) * normal(random));
  return s;
}

// Returns boundaries measured on the surface `truth`, at frequencies for which the map of `nominal` places
// them evenly from 100 to 205 mm.
std::vector<MeasuredBoundary> measured(const Surface& nominal, const Surface& truth, int count, double sd_m,
                                       std::mt19937_64& random) {
  std::normal_distribution<double> error(0, sd_m);
  std::vector<MeasuredBoundary> list;
  for (int i = 0; i < count; ++i) {
    const double f = solve_frequency_Hz(nominal, edge(), 0.1 + 0.105 * i / (count - 1)).value();
    list.push_back({f, solved_m(truth, f) + error(random), sd_m});
  }
  return list;
}

struct Errors {
  double rms_m = 0, largest_m = 0;  // largest_m: exceeded by only 5 % of the plates
  double coverage = 0;              // share of boundaries inside the stated 95 % interval
};

// Returns the errors of a map at boundaries from 100 to 205 mm on random plates, whose parameters scatter as
// `nominal` states. The map is that of a fit to `count` measured boundaries or, if `count` is 0, that of
// `nominal`.
Errors simulated(const Surface& nominal, int count, double sd_m, int plates) {
  std::mt19937_64 random(3);
  double square = 0;
  int covered = 0, checked = 0;
  std::vector<double> largest;
  for (int k = 0; k < plates; ++k) {
    const Surface truth = random_surface(nominal, random);
    Surface s = nominal;
    if (count > 0) {
      const BoundaryFit fit = fit_boundaries(nominal, edge(), measured(nominal, truth, count, sd_m, random));
      s = with_fit(nominal, fit.parameters, fit.correlations);
    }
    double worst = 0;
    for (double x = 0.100; x < 0.206; x += 0.015) {
      const double f = solve_frequency_Hz(s, edge(), x).value();
      const double error = solved_m(truth, f) - x;
      square += error * error;
      worst = std::max(worst, std::abs(error));
      covered += std::abs(error) <= 1.96 * boundary_budget(s, f, x).total_m;
      ++checked;
    }
    largest.push_back(worst);
  }
  std::sort(largest.begin(), largest.end());
  const auto most = static_cast<std::size_t>(std::ceil(0.95 * plates)) - 1;
  return {std::sqrt(square / checked), largest[most], static_cast<double>(covered) / checked};
}

}  // namespace

TEST_CASE("measured boundaries make the map of an unknown plate precise", "[physics]") {
  const char* wanted = std::getenv("TURNPOINT_PLATES");
  const int plates = wanted != nullptr ? std::atoi(wanted) : 100;
  const double slack = plates < 500 ? 1.15 : 1;  // with few plates, the results scatter more
  const double margin = plates < 500 ? 0.05 : 0.02;
  const auto say = [&](const char* what, const Errors& e) {
    if (wanted != nullptr)
      WARN(what << ": rms " << 1e3 * e.rms_m << " mm, 95 % of plates within " << 1e3 * e.largest_m
                << " mm, coverage " << 100 * e.coverage << " %");
  };
  const Errors none = simulated(plate(), 0, 0, plates);
  say("not calibrated", none);
  CHECK(none.rms_m > 9e-3);
  const Errors three = simulated(plate(), 3, 0.5e-3, plates);
  say("three boundaries of 0.5 mm", three);
  CHECK(three.rms_m < 0.45e-3 * slack);
  CHECK(three.largest_m < 1.2e-3 * slack);
  CHECK(std::abs(three.coverage - 0.95) < margin);
  const Errors five = simulated(plate(), 5, 0.2e-3, plates);
  say("five boundaries of 0.2 mm", five);
  CHECK(five.rms_m < 0.2e-3 * slack);
  CHECK(five.largest_m < 0.5e-3 * slack);
  CHECK(std::abs(five.coverage - 0.95) < margin);
}

TEST_CASE("a fit of exact boundaries finds the surface that they came from, as far as they determine it",
          "[physics]") {
  // Measured boundaries of a membrane determine only two numbers: the position of the taper's apex, and the
  // factor that relates frequency to width. With known slope and density, these two give half-width and
  // tension.
  Surface nominal = seed_brass();
  nominal.quality_factor = 60;
  nominal.sd.tension_Pa = 0.05 * nominal.tension_Pa;
  nominal.sd.half_width_m = 0.5e-3;
  Surface truth = changed(nominal, Parameter::tension, 0.06 * nominal.tension_Pa);
  truth = changed(truth, Parameter::half_width, -0.7e-3);
  std::vector<MeasuredBoundary> points;
  for (const double f : {15e3, 20e3, 40e3}) points.push_back({f, solved_m(truth, f), 1e-6});
  const BoundaryFit fit = fit_boundaries(nominal, edge(), points);
  REQUIRE(fit.parameters.size() == 2);
  CHECK(fit.parameters[0].parameter == Parameter::tension);
  CHECK(fit.parameters[0].change == Approx(0.06 * nominal.tension_Pa).epsilon(1e-4));
  CHECK(fit.parameters[1].change == Approx(-0.7e-3).epsilon(1e-3));
  CHECK(fit.parameters[1].sd < 0.01 * fit.parameters[1].prior_sd);
  for (const double residual : fit.residuals_m) CHECK(std::abs(residual) < 1e-7);
  const Surface s = with_fit(nominal, fit.parameters, fit.correlations);
  for (const double f : {18e3, 30e3}) CHECK(solved_m(s, f) == Approx(solved_m(truth, f)).margin(1e-6));
}

TEST_CASE("a fit of one linear parameter equals the closed form of its posterior", "[physics]") {
  Surface nominal = aluminium_plate();
  nominal.sd.clamp_line_m = 0.3e-3;
  const double x = solved_m(nominal, 30e3);
  const MeasuredBoundary point{30e3, x + 5e-3, 2e-3};
  const BoundaryFit fit = fit_boundaries(nominal, edge(), {&point, 1});
  // the boundary is uncertain by a standard deviation of 10 mm because of the clamp line (0.3 mm / 0.03), and
  // of 2 mm because of the measurement
  const double weight = 100.0 / 104;
  CHECK(fit.parameters.at(0).change == Approx(weight * 5e-3 * 0.03).epsilon(1e-3));
  CHECK(fit.parameters[0].sd == Approx(0.3e-3 * std::sqrt(1 - weight)).epsilon(1e-3));
  CHECK(fit.residuals_m.at(0) == Approx((1 - weight) * 5e-3).epsilon(1e-2));
  const Surface s = with_fit(nominal, fit.parameters, fit.correlations);
  CHECK(boundary_budget(s, 30e3, x).total_m ==
        Approx(std::sqrt(1 / (1 / 4.0 + 1 / 100.0)) * 1e-3).epsilon(1e-3));
}

TEST_CASE("a boundary that was read wrongly is named as an outlier", "[physics]") {
  std::mt19937_64 random(5);
  const Surface nominal = plate(), truth = random_surface(nominal, random);
  auto points = measured(nominal, truth, 6, 0.2e-3, random);
  const auto names = [&] { return fit_boundaries(nominal, edge(), points).outliers; };
  CHECK(names() == std::vector<bool>(6, false));
  points[3].boundary_m += 3e-3;
  CHECK(names() == std::vector<bool>{false, false, false, true, false, false});
  points[3].boundary_m -= 3e-3;
  points[0].boundary_m -= 10e-3;
  CHECK(names()[0]);
  // If two boundaries contradict each other, both must be named as outliers.
  points.resize(2);
  points[1] = points[0];
  points[1].boundary_m += 10e-3;
  CHECK(names() == std::vector<bool>{true, true});
}

TEST_CASE(
    "a boundary that was read wrongly does not change the fit, and boundaries that contradict each other "
    "stay in it",
    "[physics]") {
  std::mt19937_64 random(7);
  const Surface nominal = plate(), truth = random_surface(nominal, random);
  auto points = measured(nominal, truth, 6, 0.2e-3, random);
  auto others = points;
  others.erase(others.begin() + 3);
  points[3].boundary_m += 3e-3;
  const BoundaryFit fit = fit_boundaries(nominal, edge(), points),
                    clean = fit_boundaries(nominal, edge(), others);
  CHECK(fit.left_out);
  REQUIRE(fit.parameters.size() == clean.parameters.size());
  for (std::size_t j = 0; j < fit.parameters.size(); ++j) {
    CHECK(fit.parameters[j].change ==
          Approx(clean.parameters[j].change).margin(1e-9 * fit.parameters[j].prior_sd));
    CHECK(fit.parameters[j].sd == Approx(clean.parameters[j].sd));
  }
  CHECK(fit.residuals_m[3] == Approx(3e-3).margin(0.7e-3));
  CHECK(std::abs(fit.deviations[3]) > 8);
  CHECK_FALSE(clean.left_out);

  points.resize(2);
  points[1] = points[0];
  points[1].boundary_m += 10e-3;
  const BoundaryFit torn = fit_boundaries(nominal, edge(), points);
  CHECK(torn.outliers == std::vector<bool>{true, true});
  CHECK_FALSE(torn.left_out);
  CHECK(torn.residuals_m[0] == Approx(-torn.residuals_m[1]).epsilon(0.1));
}

TEST_CASE("a fit refuses measurements and surfaces that it cannot use", "[physics]") {
  const MeasuredBoundary good{30e3, 0.15, 1e-3}, vague{30e3, 0.15, 0}, below{5e3, 0.15, 1e-3};
  CHECK_THROWS_AS(fit_boundaries(plate(), edge(), {}), std::invalid_argument);
  CHECK_THROWS_AS(fit_boundaries(plate(), edge(), {&vague, 1}), Refused);
  CHECK_THROWS_AS(fit_boundaries(plate(), edge(), {&below, 1}), Refused);
  CHECK_THROWS_AS(fit_boundaries(aluminium_plate(), edge(), {&good, 1}), Refused);
}

TEST_CASE("the boundaries of a thick plate calibrate a map of either theory", "[physics]") {
  // Boundaries by Kirchhoff's theory are off by 10 to 15 mm. The fit corrects this by moving the clamp line,
  // so that no measured boundary is an outlier.
  Surface thick = plate();
  thick.theory = PlateTheory::mindlin;
  std::vector<MeasuredBoundary> points;
  for (const double f : {24e3, 33e3, 43e3}) points.push_back({f, solved_m(thick, f), 0.2e-3});
  for (const PlateTheory theory : {PlateTheory::mindlin, PlateTheory::kirchhoff}) {
    Surface nominal = plate();
    nominal.theory = theory;
    const BoundaryFit fit = fit_boundaries(nominal, edge(), points);
    const Surface s = with_fit(nominal, fit.parameters, fit.correlations);
    CHECK(std::abs(solved_m(s, 28e3) - solved_m(thick, 28e3)) < 0.5e-3);
    CHECK(std::none_of(fit.outliers.begin(), fit.outliers.end(), [](bool named) { return named; }));
  }
}

#include <cmath>
#include <cstdio>
#include <fstream>

#include "physics/boundary_budget.hpp"
#include "station/core/problem.hpp"
#include "station/core/usage_error.hpp"
#include "station/rig/apply.hpp"
#include "station/rig/calibration.hpp"
#include "station/scene/planner.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using namespace turnpoint::rig;

namespace {

std::string written(const char* name, const std::string& content) {
  static const TemporaryFolder folder;  // one folder for this process, because tests run in parallel
  const std::string path = folder / name;
  std::ofstream(path) << content;
  return path;
}

Measurements measurements() {
  std::string sweep = "frequency_Hz,displacement_um,phase_deg\n";
  for (int k = 0; k <= 60; ++k) {
    const double f = 20000 + 500 * k, u = (f - 35000) / 8000;
    sweep +=
        std::to_string(f) + "," + std::to_string(0.5 / (1 + u * u)) + "," + std::to_string(-60 * u) + "\n";
  }
  Measurements files;
  files.sweeps = {{"main", written("sweep.csv", sweep), 0.25}};
  files.boundaries_csv =
      written("boundaries.csv",
              "frequency_Hz,boundary_mm,sd_mm\n22400,97,1\n30000,147,1\n40000,190,1\n45000,206,1\n");
  files.edge = "turning";
  files.friction_csv = written("friction.csv", "displacement_um,relative_friction\n0,1\n1,0.4\n2,0.2\n");
  files.sound_csv = written("sound.csv", "frequency_Hz,level_dB\n20000,71\n40000,95\n");
  return files;
}

rig::Rig plate() { return rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml"); }

// Returns a plate that is held 0.25 mm behind the clamp's edge and is 2 % too thin.
physics::Surface other_plate() {
  const auto surface = rig::surface_of(plate());
  return physics::changed(physics::changed(surface, physics::Parameter::clamp_line, 0.25e-3),
                          physics::Parameter::thickness, -0.04e-3);
}

physics::BoundaryMap map_of(const physics::Surface& surface) {
  physics::MapOptions options;
  options.edge = physics::parse_edge("p50");
  return physics::BoundaryMap(surface, options);
}

std::vector<BoundaryPoint> points_on(const physics::BoundaryMap& map) {
  std::vector<BoundaryPoint> points;
  for (const double f : {23e3, 30e3, 44e3}) points.push_back({f, map.boundary_m(f).value(), 0.3e-3});
  return points;
}

Calibration made() {
  Calibration calibration = fit_measurements(measurements(), plate());
  calibration.rig_name = "Plate \"A\"";
  calibration.rig_sha256 = "abc";
  calibration.made_on = "2026-02-27";
  calibration.valid_days = 30;
  return calibration;
}

}  // namespace

TEST_CASE("measurements become a file that reads back as the same calibration", "[calibration]") {
  const Calibration calibration = made();
  const std::string path = written("calibration.toml", to_toml(calibration));
  const Calibration back = load_calibration(path);
  const auto& points = back.transducers.at(0).response.points;
  REQUIRE(points.size() == calibration.transducers.at(0).response.points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& made_point = calibration.transducers[0].response.points[k];
    CHECK(points[k].frequency_Hz == made_point.frequency_Hz);
    CHECK(points[k].m_per_full_scale == Approx(made_point.m_per_full_scale).epsilon(1e-14));
    CHECK(points[k].phase_rad == Approx(made_point.phase_rad).margin(1e-14));
  }
  CHECK(back.friction->points.size() == 3);
  CHECK(back.rig_name == "Plate \"A\"");
  REQUIRE(back.boundary.has_value());
  const auto &fit = *calibration.boundary, &read = *back.boundary;
  CHECK(read.edge == "turning");
  REQUIRE(read.points.size() == 4);
  CHECK(read.points[2].boundary_m == Approx(0.190));
  CHECK(read.points[2].residual_m == Approx(fit.points[2].residual_m).epsilon(1e-12));
  REQUIRE(read.surface.parameters.size() == fit.surface.parameters.size());
  for (std::size_t k = 0; k < fit.surface.parameters.size(); ++k) {
    CHECK(read.surface.parameters[k].name == fit.surface.parameters[k].name);
    CHECK(read.surface.parameters[k].change == fit.surface.parameters[k].change);
    CHECK(read.surface.parameters[k].sd == fit.surface.parameters[k].sd);
    CHECK(read.surface.parameters[k].correlations == fit.surface.parameters[k].correlations);
  }
  CHECK(back.sound.size() == 2);
}

TEST_CASE("the map of a rig with measured boundaries is that of the plate on which they were measured",
          "[calibration]") {
  const auto truth = map_of(other_plate()), stated = map_of(rig::surface_of(plate()));
  Calibration calibration;
  calibration.boundary = fit_boundaries(plate(), "p50", points_on(truth));
  const auto fitted = map_of(rig::surface_of(applied(calibration, plate())));
  for (const double f : {25e3, 33e3, 42e3}) {
    const double x = truth.boundary_m(f).value();
    CHECK(std::abs(fitted.boundary_m(f).value() - x) < 0.3e-3);
    CHECK(std::abs(stated.boundary_m(f).value() - x) > 8e-3);
    CHECK(fitted.at_frequency(f).uncertainty_m < 0.4e-3);
    CHECK(stated.at_frequency(f).uncertainty_m > 7e-3);
  }
  CHECK(problems(calibration, "", calibration.made_on = today()).empty());
}

TEST_CASE("boundaries that cannot be used are refused, wrong ones are named", "[calibration]") {
  auto points = points_on(map_of(other_plate()));
  points[1].boundary_m += 10e-3;
  Calibration calibration;
  calibration.boundary = fit_boundaries(plate(), "p50", points);
  CHECK(calibration.boundary->points[1].outlier);
  CHECK(calibration.boundary->points[1].left_out);
  CHECK_FALSE(calibration.boundary->points[0].left_out);
  calibration.rig_name = "r", calibration.rig_sha256 = "abc", calibration.made_on = "2026-02-27";
  auto text = to_toml(calibration);
  CHECK(parse_calibration(text, "a.toml").boundary->points[1].left_out);
  const auto line = text.find("left_out");
  text.erase(line, text.find('\n', line) - line);
  CHECK_THROWS_AS(parse_calibration(text, "a.toml"), core::BadInput);
  points[1].sd_m = 0;
  CHECK_THROWS_AS(fit_boundaries(plate(), "p50", points), core::UsageError);
  CHECK_THROWS_AS(fit_boundaries(plate(), "friction=0.7", points), core::UsageError);
  CHECK_THROWS_AS(fit_boundaries(plate(), "p50", {}), core::UsageError);
}

TEST_CASE("a calibration expires, belongs to one rig file, and says why it must not be used",
          "[calibration]") {
  const Calibration calibration = made();
  CHECK(days_left(calibration, "2026-02-27") == 30);
  CHECK(days_left(calibration, "2026-03-29") == 0);
  CHECK(problems(calibration, "abc", "2026-03-29").empty());
  CHECK(core::say(problems(calibration, "abc", "2026-03-30").at(0), "en") ==
        "the calibration of 2026-02-27 has expired; days since then: 1");
  CHECK(core::say(problems(calibration, "abc", "2026-03-30").at(0), "de") ==
        "die Kalibrierung vom 2026-02-27 ist abgelaufen; Tage seitdem: 1");
  CHECK(problems(calibration, "abd", "2026-03-01").size() == 1);
  CHECK(problems(calibration, "abc", "2026-02-01").size() == 1);
  CHECK_THROWS_AS(days_left(calibration, "2026-02-30"), core::UsageError);
}

TEST_CASE("all problems of all files are reported together, each with its place", "[calibration]") {
  Measurements files = measurements();
  files.friction_csv = written("bad_friction.csv", "displacement_um,friction\n0,1\n");
  files.sound_csv = written("bad_sound.csv", "frequency_Hz,level_dB\n20000,loud\n");
  try {
    fit_measurements(files, plate());
    FAIL("accepted");
  } catch (const core::BadInput& error) {
    CHECK(error.problems().size() >= 2);
  }
  CHECK_THROWS_AS(load_calibration(written("bad.toml", "format = \"friction-calibration/1\"\nrig = 3\n")),
                  core::BadInput);
}

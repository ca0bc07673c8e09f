#include <cmath>
#include <cstdio>
#include <fstream>

#include "station/calibration/calibration.hpp"
#include "station/terms/usage_error.hpp"
#include "station/text/problem.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using namespace turnpoint::calibration;

namespace {

std::string written(const char* name, const std::string& content) {
  static const TemporaryFolder folder;  // a folder of its own, because tests run in parallel
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
  files.friction_csv = written("friction.csv", "displacement_um,relative_friction\n0,1\n1,0.4\n2,0.2\n");
  files.sound_csv = written("sound.csv", "frequency_Hz,level_dB\n20000,71\n40000,95\n");
  return files;
}

Calibration made() {
  Calibration calibration = fit_measurements(measurements());
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
  const Calibration back = load(path);
  const auto& points = back.transducers.at(0).response.points;
  REQUIRE(points.size() == calibration.transducers.at(0).response.points.size());
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto& made_point = calibration.transducers[0].response.points[k];
    CHECK(points[k].frequency_Hz == made_point.frequency_Hz);
    CHECK(points[k].m_per_full_scale == Approx(made_point.m_per_full_scale).epsilon(1e-14));
    CHECK(points[k].phase_rad == Approx(made_point.phase_rad).margin(1e-14));
  }
  CHECK(back.boundary->apex_m == Approx(calibration.boundary->apex_m).epsilon(1e-14));
  CHECK(back.friction->points.size() == 3);
  CHECK(back.rig_name == "Plate \"A\"");
  REQUIRE(back.boundary.has_value());
  CHECK(back.boundary->law == BoundaryFit::Law::plate);
  CHECK(boundary_at(*back.boundary, 30000) == Approx(0.147).margin(0.002));
  CHECK(back.sound.size() == 2);
}

TEST_CASE("a calibration expires, belongs to one rig file, and says so", "[calibration]") {
  const Calibration calibration = made();
  CHECK(days_left(calibration, "2026-02-27") == 30);
  CHECK(days_left(calibration, "2026-03-29") == 0);
  CHECK(problems(calibration, "abc", "2026-03-29").empty());
  CHECK(problems(calibration, "abc", "2026-03-30").at(0) ==
        "the calibration of 2026-02-27 expired 1 days ago");
  CHECK(problems(calibration, "abd", "2026-03-01").size() == 1);
  CHECK(problems(calibration, "abc", "2026-02-01").size() == 1);
  CHECK_THROWS_AS(days_left(calibration, "2026-02-30"), terms::UsageError);
}

TEST_CASE("all problems of all files are reported together, each with its place", "[calibration]") {
  Measurements files = measurements();
  files.friction_csv = written("bad_friction.csv", "displacement_um,friction\n0,1\n");
  files.sound_csv = written("bad_sound.csv", "frequency_Hz,level_dB\n20000,loud\n");
  try {
    fit_measurements(files);
    FAIL("accepted");
  } catch (const text::BadInput& error) {
    CHECK(error.problems().size() >= 2);
  }
  CHECK_THROWS_AS(load(written("bad.toml", "format = \"friction-calibration/1\"\nrig = 3\n")),
                  text::BadInput);
}

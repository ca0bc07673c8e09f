// Measurements point by point: what an operator reads goes into the calibration, and nothing else changes.
#include <cmath>
#include <filesystem>
#include <string>

#include "station/calibration/apply.hpp"
#include "station/maintenance/guided_series.hpp"
#include "station/system/read_file.hpp"
#include "station/terms/usage_error.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using maintenance::Series;

namespace {

rig::Rig rig_in(const TemporaryFolder& folder) {
  const auto path = folder / "plate.toml";
  if (!std::filesystem::exists(path))
    std::filesystem::copy_file(std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/simulated.toml", path);
  return rig::load(path);
}

}  // namespace

TEST_CASE("the tones of a series are inaudible, inside the band, and of the stated displacement",
          "[maintenance]") {
  const TemporaryFolder folder;
  const auto rig = rig_in(folder);
  for (const auto series : {Series::response, Series::boundaries, Series::friction, Series::sound}) {
    const auto points = maintenance::series_points(rig, series);
    CHECK(static_cast<int>(points.size()) >= maintenance::least_points(series));
    for (const auto& point : points) {
      CHECK(point.frequency_Hz >= 22'400);
      CHECK(point.frequency_Hz <= 60'000);
      // the rig file says 4 um at full scale
      CHECK(std::abs(point.displacement_um - 4 * point.full_scale) < 1e-9);
      CHECK(1e-6 * point.displacement_um <= rig.limits.displacement_m);
    }
  }
}

TEST_CASE("a sound level read at a tenth of full scale is 20 dB higher at full scale", "[maintenance]") {
  const TemporaryFolder folder;
  const auto rig = rig_in(folder);
  auto points = maintenance::series_points(rig, Series::sound);
  for (auto& point : points) point.value = 61.5;
  points.back().value.reset();  // a point that was not read is left out
  const auto result = maintenance::finish_series(rig, Series::sound, points);
  const auto made = calibration::load(result.file);
  REQUIRE(made.sound.size() == points.size() - 1);
  for (const auto& point : made.sound) CHECK(std::abs(point.level_dB - 81.5) < 0.01);
  CHECK(result.file == calibration::newest_for(rig.path));
}

TEST_CASE("a series replaces only its own part of the calibration", "[maintenance]") {
  const TemporaryFolder folder;
  const auto rig = rig_in(folder);
  auto sound = maintenance::series_points(rig, Series::sound);
  for (auto& point : sound) point.value = 50;
  maintenance::finish_series(rig, Series::sound, sound);
  auto friction = maintenance::series_points(rig, Series::friction);
  double value = 0.9;
  for (auto& point : friction) point.value = value -= 0.1;
  const auto result = maintenance::finish_series(rig, Series::friction, friction);
  const auto made = calibration::load(result.file);
  CHECK(made.sound.size() == sound.size());
  REQUIRE(made.friction.has_value());
  REQUIRE(made.friction->points.size() == friction.size() + 1);  // and the surface at rest
  CHECK(std::abs(made.friction->points[1].relative_friction - 0.8) < 1e-6);
  CHECK(system::read_file(result.csv).find("displacement_um,relative_friction\n0,1\n") == 0);
}

TEST_CASE("boundaries that the physics predicts are fitted without a large change of the surface",
          "[maintenance]") {
  const TemporaryFolder folder;
  const auto rig = rig_in(folder);
  auto points = maintenance::series_points(rig, Series::boundaries);
  CHECK_THROWS_AS(maintenance::finish_series(rig, Series::boundaries, points), terms::UsageError);
  // the comment of the rig file: 76 mm at 22.4 kHz and 226 mm at 48 kHz, by another plate theory
  for (auto& point : points) point.value = 84 + (point.frequency_Hz - 22'400) / 25'600 * 142;
  const auto result = maintenance::finish_series(rig, Series::boundaries, points);
  REQUIRE(result.made.boundary.has_value());
  CHECK(result.made.boundary->points.size() == points.size());
  CHECK(result.figure.charts.size() == 2);
}

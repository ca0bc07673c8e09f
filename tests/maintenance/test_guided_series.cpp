// Measurements point by point: what an operator reads goes into the calibration, and nothing else changes.
#include <cmath>
#include <filesystem>
#include <string>

#include "station/core/read_file.hpp"
#include "station/core/usage_error.hpp"
#include "station/maintenance/guided_series.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/rig/apply.hpp"
#include "station/sensing/pick_up.hpp"
#include "station/session/simulated_room.hpp"
#include "station/system/write_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using maintenance::Series;

namespace {

rig::Rig rig_in(const TemporaryFolder& folder, const std::string& name = "simulated") {
  const auto path = folder / "plate.toml";
  if (!std::filesystem::exists(path))
    std::filesystem::copy_file(std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/" + name + ".toml", path);
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
  const auto made = rig::load_calibration(result.file);
  REQUIRE(made.sound.size() == points.size() - 1);
  for (const auto& point : made.sound) CHECK(std::abs(point.level_dB - 81.5) < 0.01);
  CHECK(result.file == rig::newest_for(rig.path));
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
  const auto made = rig::load_calibration(result.file);
  CHECK(made.sound.size() == sound.size());
  REQUIRE(made.friction.has_value());
  REQUIRE(made.friction->points.size() == friction.size() + 1);  // and the surface at rest
  CHECK(std::abs(made.friction->points[1].relative_friction - 0.8) < 1e-6);
  CHECK(core::read_file(result.csv).find("displacement_um,relative_friction\n0,1\n") == 0);
}

TEST_CASE("boundaries that the physics predicts are fitted without a large change of the surface",
          "[maintenance]") {
  const TemporaryFolder folder;
  const auto rig = rig_in(folder);
  auto points = maintenance::series_points(rig, Series::boundaries);
  CHECK_THROWS_AS(maintenance::finish_series(rig, Series::boundaries, points), core::UsageError);
  // the comment of the rig file: 76 mm at 22.4 kHz and 226 mm at 48 kHz, by another plate theory
  for (auto& point : points) point.value = 84 + (point.frequency_Hz - 22'400) / 25'600 * 142;
  const auto result = maintenance::finish_series(rig, Series::boundaries, points);
  REQUIRE(result.made.boundary.has_value());
  CHECK(result.made.boundary->points.size() == points.size());
  CHECK(result.figure.charts.size() == 2);
}

TEST_CASE("while a tone of a series plays, the pick-ups are read, in um once their scale is calibrated",
          "[maintenance]") {
  const TemporaryFolder folder;
  const auto rig = rig_in(folder, "simulated-forces");
  REQUIRE(maintenance::reads_tones(rig));
  const auto points = maintenance::series_points(rig, Series::response);
  const auto& point = points[points.size() / 2];
  std::vector<std::vector<maintenance::ToneReading>> seen;
  const auto play = [&] {
    seen.clear();
    maintenance::play_point(rig, point, {}, [&](const auto& readings) { seen.push_back(readings); });
  };
  play();
  CHECK(seen.size() >= 15);  // five a second, for 4 s
  const auto plate = session::SimulatedRoom(rig).capture();
  for (std::size_t k = 0; k < rig.capture->pick_ups.size(); ++k) {
    const auto& reading = seen.at(seen.size() / 2).at(k);
    CHECK(reading.channel == rig.capture->pick_ups[k]);
    CHECK_FALSE(reading.displacement_um.has_value());
    const auto response = sensing::response(plate.pick_ups[k], 0, point.frequency_Hz);
    CHECK(std::abs(reading.amplitude / (point.full_scale * std::abs(response.value())) - 1) < 0.01);
  }

  auto made = maintenance::known_calibration(rig);
  rig::PickUp pick_up;
  pick_up.response.channel = rig.capture->pick_ups[0];
  pick_up.response.points = {{30e3, 0.1, 0}, {31e3, 0.1, 0}};
  pick_up.scale = rig::PickUpScale{rig::PickUpSensor::patch, 10, 30e3, 0, 0.02};
  made.pick_ups = {pick_up};
  system::write_file(rig::file_for(rig.path, rig::today()), rig::to_toml(made));
  play();
  const auto& reading = seen.at(seen.size() / 2).at(0);
  CHECK(std::abs(reading.displacement_um.value() / (10 * reading.amplitude) - 1) < 1e-9);
}

TEST_CASE("a tone of a series can be stopped", "[maintenance]") {
  const TemporaryFolder folder;
  const auto rig = rig_in(folder, "simulated-forces");
  std::stop_source stop;
  int readings = 0;
  maintenance::play_point(rig, maintenance::series_points(rig, Series::sound).front(), stop.get_token(),
                          [&](const auto&) {
                            if (++readings == 2) stop.request_stop();
                          });
  CHECK(readings <= 3);
}

TEST_CASE("a rig without pick-ups only plays, and reads nothing", "[maintenance]") {
  const TemporaryFolder folder;
  const auto rig = rig_in(folder);
  CHECK_FALSE(maintenance::reads_tones(rig));
  int readings = 0;
  maintenance::play_point(rig, maintenance::series_points(rig, Series::sound).front(), {},
                          [&](const auto&) { ++readings; });
  CHECK(readings == 0);
}

#include <filesystem>
#include <fstream>

#include "station/core/problem.hpp"
#include "station/core/usage_error.hpp"
#include "station/rig/apply.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::rig;

namespace {

Calibration measured() {
  Calibration calibration;
  Calibration::Transducer transducer;
  transducer.name = "main";
  transducer.response.points = {{20000, 2e-6, 0.1}, {30000, 4e-6, 0.2}, {40000, 2e-6, 0.3}};
  transducer.response.low_Hz = 20000;
  transducer.response.high_Hz = 40000;
  calibration.transducers.push_back(transducer);
  calibration.quality_factor = 41;
  calibration.friction = FrictionFit{{{0, 1}, {1e-6, 0.4}}, 0};
  return calibration;
}

rig::Rig plate() { return rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml"); }

}  // namespace

TEST_CASE("a calibrated rig has the measured response, band, loss and friction", "[calibration][apply]") {
  auto before = plate();
  before.surface.quality_factor = 30, before.surface.quality_factor_sd = 6;
  const auto rig = applied(measured(), before);
  CHECK_FALSE(rig.transducers.at(0).m_per_full_scale.has_value());
  CHECK(rig.transducers[0].response.size() == 3);
  CHECK(rig.transducers[0].low_Hz == 20000);
  CHECK(rig.transducers[0].high_Hz == 40000);
  CHECK(rig.surface.quality_factor == 41);
  CHECK(rig.surface.quality_factor_sd == Approx(41.0 * 6 / 30));
  CHECK(rig.friction.measured);
  CHECK(rig.friction.table.size() == 2);
  CHECK(rig.sha256 == plate().sha256);
}

TEST_CASE("a transducer of another rig, or without a common band, is refused", "[calibration][apply]") {
  auto calibration = measured();
  calibration.transducers[0].name = "other";
  CHECK_THROWS_AS(applied(calibration, plate()), core::UsageError);
  calibration = measured();
  calibration.transducers[0].response.low_Hz = 70000;
  calibration.transducers[0].response.high_Hz = 80000;
  CHECK_THROWS_AS(applied(calibration, plate()), core::UsageError);
}

TEST_CASE("a calibration contains the response of each pick-up to each transducer", "[calibration][apply]") {
  auto rig = plate();
  rig.capture = rig::Capture{"alsa:hw:1", 4, {1, 3}, 0, 2, {}};
  CHECK(rig::unproven_transducers(rig) == std::vector<std::string>{rig.transducers[0].name});
  auto calibration = measured();
  const int drive = rig.transducers[0].channel;
  calibration.pick_ups.resize(1);
  calibration.pick_ups[0].response = {1, drive, {{20'000, 0.1, 0.5}, {30'000, 0.2, -0.25}}};
  calibration.rig_name = "r", calibration.rig_sha256 = "abc", calibration.made_on = "2026-02-27";
  const auto again = parse_calibration(to_toml(calibration), "a.toml");
  REQUIRE(again.pick_ups.size() == 1);
  CHECK(to_toml(again) == to_toml(calibration));
  const auto made = applied(again, rig);
  REQUIRE(made.capture->responses.size() == 1);
  const auto& response = made.capture->responses[0];
  CHECK(response.channel == 1);
  CHECK(response.drive_channel == drive);
  REQUIRE(response.points.size() == 2);
  CHECK(response.points[1].frequency_Hz == 30'000);
  CHECK(response.points[1].amplitude == 0.2);
  CHECK(response.points[1].phase_rad == Approx(-0.25));
  CHECK(rig::unproven_transducers(made).empty());
  CHECK(rig::unproven_transducers(plate()).empty());  // this rig has no capture channels

  calibration.pick_ups.push_back(calibration.pick_ups[0]);
  CHECK_THROWS_WITH(applied(calibration, rig),
                    "the calibration has two responses of the pick-up on channel 1 to output channel " +
                        std::to_string(drive));
  calibration.pick_ups.resize(1);
  calibration.pick_ups[0].response = {2, drive, {{20'000, 0.1, 0}, {30'000, 0.2, 0}}};
  CHECK_THROWS_WITH(applied(calibration, rig),
                    "the calibration has a pick-up on captured channel 2, but the rig does not");
  CHECK_THROWS_AS(applied(calibration, plate()), core::UsageError);
}

TEST_CASE("the columns of a pick-up's table must have equal length and be in order of frequency",
          "[calibration][apply]") {
  const auto problem = [](const std::string& columns) {
    Calibration calibration;
    calibration.rig_name = "r", calibration.rig_sha256 = "abc", calibration.made_on = "2026-02-27";
    try {
      parse_calibration(to_toml(calibration) + "[[pickup]]\nchannel = 1\ndrive_channel = 0\n" + columns,
                        "a.toml");
      return std::string();
    } catch (const core::BadInput& error) {
      return std::string(error.what());
    }
  };
  CHECK(problem("frequency_Hz = [1, 2]\namplitude = [1, 1]\nphase_deg = [0, 0]\n") == "");
  CHECK(problem("frequency_Hz = [1, 2]\namplitude = [1]\nphase_deg = [0, 0]\n") != "");
  CHECK(problem("frequency_Hz = [2, 1]\namplitude = [1, 1]\nphase_deg = [0, 0]\n")
            .find("not in ascending order") != std::string::npos);
  CHECK(problem("frequency_Hz = [1, 2]\namplitude = [1, -1]\nphase_deg = [0, 0]\n") != "");
}

TEST_CASE("the newest calibration beside a rig is found by its date", "[calibration][apply]") {
  const auto folder = std::filesystem::path(TURNPOINT_BINARY_DIR) / "calibrations-beside";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const auto rig = (folder / "plate.toml").string();
  CHECK(newest_for(rig).empty());
  for (const char* date : {"2026-02-01", "2026-11-20", "2025-12-31"}) std::ofstream(file_for(rig, date));
  std::ofstream(folder / "plate.calibration-newest.toml");
  std::ofstream(folder / "plates.calibration-2027-01-01.toml");
  CHECK(newest_for(rig) == file_for(rig, "2026-11-20"));
}

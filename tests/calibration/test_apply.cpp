#include <filesystem>
#include <fstream>

#include "station/calibration/apply.hpp"
#include "station/terms/usage_error.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace turnpoint::calibration;

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

rig::Rig plate() { return rig::load(std::string(TURNPOINT_SOURCE_DIR) + "/deploy/rigs/simulated.toml"); }

}  // namespace

TEST_CASE("a calibrated rig has the measured response, band, loss and friction", "[calibration][apply]") {
  const auto rig = applied(measured(), plate());
  CHECK_FALSE(rig.transducers.at(0).m_per_full_scale.has_value());
  CHECK(rig.transducers[0].response.size() == 3);
  CHECK(rig.transducers[0].low_Hz == 20000);
  CHECK(rig.transducers[0].high_Hz == 40000);
  CHECK(rig.surface.quality_factor == 41);
  CHECK(rig.friction.measured);
  CHECK(rig.friction.table.size() == 2);
  CHECK(rig.sha256 == plate().sha256);
}

TEST_CASE("a transducer of another rig, or without a common band, is refused", "[calibration][apply]") {
  auto calibration = measured();
  calibration.transducers[0].name = "other";
  CHECK_THROWS_AS(applied(calibration, plate()), terms::UsageError);
  calibration = measured();
  calibration.transducers[0].response.low_Hz = 70000;
  calibration.transducers[0].response.high_Hz = 80000;
  CHECK_THROWS_AS(applied(calibration, plate()), terms::UsageError);
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

#include "station/maintenance/drive_crosstalk.hpp"

#include <cmath>

#include "station/core/usage_error.hpp"
#include "station/maintenance/force_weights.hpp"
#include "station/rig/apply.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using maintenance::measure_drive_crosstalk;
using Status = io::Finding::Status;

namespace {

rig::Rig calibrated_rig(const TemporaryFolder& folder) {
  auto rig = rig::load(measured::with_capture(folder, measured::kCells));
  rig.capture->forces = maintenance::weigh(
                            rig, *maintenance::open_bridges(rig), [](const auto&) { return true; },
                            [](const auto&) { return false; })
                            .cells;
  return rig;
}

}  // namespace

TEST_CASE("the drive must not change the force of a weight at rest by more than 1 mN",
          "[maintenance][doctor]") {
  const TemporaryFolder folder;
  const auto rig = calibrated_rig(folder);
  const auto readings = measure_drive_crosstalk(rig);
  REQUIRE(readings.size() == 1);
  CHECK(readings[0].transducer == "main");
  CHECK(std::abs(readings[0].normal_mN) < 0.2);
  CHECK(readings[0].restless_mN < 1);
  CHECK(maintenance::judged(readings[0]).status == Status::ok);

  // Wires that are not shielded, and amplifiers that distort: the force follows the drive.
  const auto bad = measure_drive_crosstalk(rig, [](simulation::Setup& room) {
    room.wires.crosstalk_V_per_full_scale = 10e-3;
    room.wires.a3_per_V2 = 2e-3;
  });
  CHECK(std::abs(bad.at(0).normal_mN) > 2);
  const auto finding = maintenance::judged(bad[0]);
  CHECK(finding.status == Status::failed);
  CHECK(core::say(finding.what, "en").find("at most 1 mN are allowed") != std::string::npos);
  CHECK_FALSE(finding.mend.key.empty());

  // A weight that does not rest says nothing about the drive.
  const auto noisy =
      measure_drive_crosstalk(rig, [](simulation::Setup& room) { room.wires.noise_V_per_rtHz = 80e-9; });
  CHECK(maintenance::judged(noisy.at(0)).what.key == "doctor.drive_restless");
}

TEST_CASE("the check with a weight needs calibrated force cells on the sound card", "[maintenance][doctor]") {
  const TemporaryFolder folder;
  const auto uncalibrated = rig::load(measured::with_capture(folder, measured::kCells));
  CHECK_THROWS_WITH(measure_drive_crosstalk(uncalibrated),
                    Catch::Matchers::ContainsSubstring("needs calibrated force cells"));
  const auto without = rig::load(measured::with_capture(folder, measured::kPickUps));
  CHECK_THROWS_AS(measure_drive_crosstalk(without), core::UsageError);
}

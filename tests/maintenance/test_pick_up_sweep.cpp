#include <cmath>
#include <complex>
#include <fstream>

#include "station/core/usage_error.hpp"
#include "station/maintenance/pick_up_sweep.hpp"
#include "station/rig/apply.hpp"
#include "station/session/simulated_room.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"

using namespace turnpoint;
using maintenance::calibrate_pick_ups;
using maintenance::PickUpOptions;

namespace {

// sensitivity of the simulated pick-ups, and displacement of the simulated transducer at full scale
constexpr double kFullScalePerUm = 0.1, kUmPerFullScale = 4;

/// Writes the table of an instrument whose readings are wrong by the factor `error` and by this `power` of
/// frequency.
std::string table(const TemporaryFolder& folder, const simulation::Plant& plant, double error,
                  const std::vector<double>& frequencies, double power = 0) {
  const auto path = folder / "vibrometer.csv";
  std::ofstream file(path);
  file << "frequency_Hz,displacement_um\n";
  for (const double f : frequencies)
    file << f << ","
         << error * kUmPerFullScale * std::abs(plant.pickup_response(0, f)) * std::pow(f / 3e4, power)
         << "\n";
  return "1=" + path;
}

const std::vector<double> kFrequencies{24e3, 28e3, 32e3, 36e3, 40e3, 44e3};

std::string refusal(const rig::Rig& rig, const PickUpOptions& options) {
  try {
    calibrate_pick_ups(rig, options);
  } catch (const core::UsageError& error) {
    return error.what();
  } catch (const core::BadInput& error) {
    return error.what();
  }
  return "";
}

/// Runs the demo with a calibration file.
session::Summary run_with(const TemporaryFolder& folder, const std::string& rig,
                          const std::string& calibration, std::vector<core::TrialRow>& trials) {
  auto request = simulated_run(measured::shipped("demo"), folder / "a.sqlite", 7);
  request.rig = rig;
  request.calibration = calibration;
  session::Inputs inputs;
  measured::Pages pages;
  const auto summary = session::run(session::prepare(request), &pages, inputs);
  for (const auto& block : store::read_session(request.database, summary.session_id).blocks)
    trials.insert(trials.end(), block.trials.begin(), block.trials.end());
  return summary;
}

}  // namespace

TEST_CASE("a sweep recovers response, resonances and scale of the simulated pick-ups within what it states",
          "[maintenance][pickup]") {
  const TemporaryFolder folder;
  const auto rig = rig::load(measured::with_capture(folder, measured::kPickUps));
  session::SimulatedRoom room(rig);
  const auto& plant = room.plant();
  PickUpOptions options;
  options.vibrometer = table(folder, plant, 1.04, kFrequencies);
  const auto made = calibrate_pick_ups(rig, options);
  REQUIRE(made.size() == 2);
  for (std::size_t p = 0; p < 2; ++p) {
    const auto& [response, sd, resonances, scale] = made[p];
    CHECK(response.channel == static_cast<int>(p) + 1);
    CHECK(sd < 0.01);
    double largest = 0;
    for (const auto& point : response.points) largest = std::max(largest, point.amplitude);
    for (const auto& point : response.points) {
      const auto truth = plant.pickup_response(p, point.frequency_Hz) * kUmPerFullScale * kFullScalePerUm;
      INFO(point.frequency_Hz << " Hz");
      CHECK(std::abs(std::polar(point.amplitude, point.phase_rad) - truth) < 5 * sd * largest);
    }
    REQUIRE(resonances.size() >= 3);
    for (const auto& found : resonances) {
      double nearest_Hz = 1e9, quality = 0;
      for (const auto& [f, q] : plant.resonances())
        if (std::abs(f - found.frequency_Hz) < std::abs(nearest_Hz - found.frequency_Hz))
          nearest_Hz = f, quality = q;
      INFO(found.frequency_Hz << " +- " << found.frequency_sd_Hz << " Hz, Q " << found.quality_factor
                              << " +- " << found.quality_sd << "; true " << nearest_Hz << " Hz, Q "
                              << quality);
      CHECK(std::abs(found.frequency_Hz - nearest_Hz) < 4 * found.frequency_sd_Hz);
      CHECK(std::abs(found.quality_factor - quality) < 4 * found.quality_sd);
      CHECK(found.frequency_sd_Hz < 60);
    }
  }
  const auto& scale = made[0].scale.value();
  CHECK(scale.sd > 0.05);
  CHECK(scale.sd < 0.06);
  for (const double f : kFrequencies) CHECK(std::abs(scale.at(f) * kFullScalePerUm - 1) < 1.5 * scale.sd);
  CHECK(std::abs(scale.exponent) < 0.05);
  CHECK_FALSE(made[1].scale.has_value());
}

TEST_CASE("a session with the calibration of a sweep is proven, and one with wrong values is stopped",
          "[maintenance][pickup]") {
  const TemporaryFolder folder;
  const auto path = measured::with_capture(folder, measured::kPickUps);
  const auto rig = rig::load(path);
  auto calibration = maintenance::with_pick_ups(rig, calibrate_pick_ups(rig, {}));
  const auto write = [&](const std::string& name) {
    std::ofstream(folder / name) << rig::to_toml(calibration);
    return folder / name;
  };
  std::vector<core::TrialRow> good, bad, late;
  CHECK(run_with(folder, path, write("good.toml"), good).voided == 0);
  REQUIRE(good.size() == 10);
  for (const auto& trial : good) {
    CHECK(trial.surface.proof == core::Proof::ok);
    CHECK(std::abs(trial.surface.drive_ratio_dB.value()) < 0.05);
  }
  for (auto& pick_up : calibration.pick_ups)
    for (auto& point : pick_up.response.points) point.amplitude *= 1.25;  // change the amplitude by 1.9 dB
  CHECK(run_with(folder, path, write("loud.toml"), bad).status == core::SessionStatus::interrupted);
  REQUIRE_FALSE(bad.empty());
  for (const auto& trial : bad) {
    INFO(trial.trial_index << " " << name(trial.surface.proof) << " " << name(trial.surface.proof_cause));
    CHECK(trial.outcome == core::Outcome::fault);
    CHECK(trial.surface.drive_ratio_dB.value() == Approx(-1.94).margin(0.05));
  }
  for (auto& pick_up : calibration.pick_ups)
    for (auto& point : pick_up.response.points)
      point.amplitude /= 1.25, point.phase_rad += 0.35;  // change the phase by 20 degrees
  CHECK(run_with(folder, path, write("turned.toml"), late).voided == 0);
  for (const auto& trial : late) CHECK(trial.surface.proof == core::Proof::flagged);
}

TEST_CASE("a table that contradicts the sweep, has another unit, or is too short is refused",
          "[maintenance][pickup]") {
  const TemporaryFolder folder;
  const auto rig = rig::load(measured::with_capture(folder, measured::kPickUps));
  session::SimulatedRoom room(rig);
  PickUpOptions options;
  // a table in nanometres instead of micrometres must be refused
  options.vibrometer = table(folder, room.plant(), 1000, kFrequencies);
  CHECK(refusal(rig, options).find("check the unit") != std::string::npos);
  options.vibrometer = table(folder, room.plant(), 1, {24e3, 28e3, 32e3, 36e3});
  CHECK(refusal(rig, options).find("needs 5 or more") != std::string::npos);
  options.vibrometer = table(folder, room.plant(), 1, {15e3, 28e3, 32e3, 36e3, 40e3});
  CHECK(refusal(rig, options).find("outside of the sweep") != std::string::npos);
  // a pick-up at another place, or another sensor, would give such a table
  options.vibrometer = table(folder, room.plant(), 1, kFrequencies, 6);
  CHECK(refusal(rig, options).find("proportional to the power") != std::string::npos);
  options.vibrometer = folder / "wrong.csv";
  std::ofstream(options.vibrometer)
      << "frequency_Hz,displacement_um\n24000,4\n28000,1\n32000,7\n36000,2\n40000,9\n";
  options.vibrometer = "1=" + options.vibrometer;
  CHECK(refusal(rig, options).find("differ by") != std::string::npos);
  options.vibrometer = "7=" + (folder / "wrong.csv");
  CHECK(refusal(rig, options).find("no pick-up on captured channel 7") != std::string::npos);
  options.vibrometer = "1=" + (folder / "absent.csv");
  CHECK(refusal(rig, options).find("absent.csv") != std::string::npos);
}

TEST_CASE("an accelerometer needs one frequency, because its sensitivity follows from physics",
          "[maintenance][pickup]") {
  rig::PickUp pick_up;
  for (double f = 22e3; f <= 46e3; f += 100) pick_up.response.points.push_back({f, 0.2 * f * f / 9e8, 0});
  const auto scale = rig::fit_scale(pick_up, rig::PickUpSensor::accelerometer, {{30e3, 2}}, 0.03);
  CHECK(scale.at(30e3) == Approx(10));
  CHECK(scale.at(42e3) == Approx(10 / 1.96));
  CHECK(scale.sd == Approx(0.03));
  CHECK_THROWS_AS(rig::fit_scale(pick_up, rig::PickUpSensor::patch, {{30e3, 2}}, 0.03), core::UsageError);
}

TEST_CASE("a pick-up that captures only noise is refused with its channel", "[maintenance][pickup]") {
  const TemporaryFolder folder;
  const auto rig = rig::load(measured::with_capture(folder, measured::kPickUps));
  PickUpOptions options;
  options.laboratory = [](simulation::Setup& room) { room.pickups[1].full_scale_per_um = 1e-7; };
  CHECK(refusal(rig, options).find("pick-up on channel 2 captures nothing but noise") != std::string::npos);
}

#include <cmath>
#include <filesystem>

#include "physics/boundary_map.hpp"
#include "physics/centre_line.hpp"
#include "station/scene/planner.hpp"
#include "station/system/thermometer.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"

using namespace turnpoint;
using namespace measured;

namespace {

/// A folder like /sys/class/hwmon with sensors.
struct Sensors {
  TemporaryFolder folder;
  Sensors() {
    add("hwmon0", "lm75", "1-0048");
    add("hwmon1", "lm75", "1-0049");
    add("hwmon2", "cpu_thermal", "soc");
  }
  void add(const std::string& directory, const std::string& name, const std::string& device) {
    const auto at = std::filesystem::path(folder / directory);
    std::filesystem::create_directories(at);
    std::filesystem::create_directories(folder / ("devices-" + device) / std::filesystem::path(device));
    std::filesystem::create_directory_symlink(folder / ("devices-" + device) / std::filesystem::path(device),
                                              at / "device");
    std::ofstream(at / "name") << name << "\n";
    set(directory, 23);
  }
  void set(const std::string& directory, double degrees_C) {
    std::ofstream(std::filesystem::path(folder / directory) / "temp1_input")
        << std::lround(1e3 * degrees_C) << "\n";
  }
};

const char* const kThermometers =
    "[temperature]\nplate = \"hwmon:lm75@1-0048/temp1\"\nframe = \"hwmon:lm75@1-0049/temp1\"\n";

struct DriftRun {
  std::vector<core::TrialRow> trials;
  std::vector<core::EventRow> events;
  rig::Rig rig;
  /// factor by which the resonances of the simulated surface have really changed at the end
  double resonance = 1;
};

/// Runs the demo protocol in a simulated room that is warmer by `warmth_K` from the third trial on.
DriftRun run_warm(double warmth_K, Sensors& sensors, const std::string& extra = "") {
  TemporaryFolder folder;
  auto request = simulated_run(shipped("demo"), folder / "a.sqlite", 7);
  request.rig = with_capture(folder, kPickUps + extra);
  auto setup = session::prepare(request);
  setup.thermometers = sensors.folder.path;
  auto room = std::make_unique<session::SimulatedRoom>(setup.rig);
  auto& plant = room->plant();
  const double cold_Hz = plant.resonances().front().first;
  Saboteur saboteur;
  saboteur.before = [&](int trial) {
    if (trial != 2 || warmth_K == 0) return;
    plant.add({simulation::FaultKind::warmer, plant.frames() + 1, simulation::kNever, warmth_K, 0});
    sensors.set("hwmon0", 23 + warmth_K);
  };
  DriftRun ran;
  saboteur.after = [&](int) { ran.resonance = plant.resonances().front().first / cold_Hz; };
  Pages pages;
  session::Inputs inputs;
  const auto summary = session::run(setup, &pages, inputs, std::move(room), &saboteur);
  const auto stored = store::read_session(request.database, summary.session_id);
  for (const auto& block : stored.blocks)
    ran.trials.insert(ran.trials.end(), block.trials.begin(), block.trials.end());
  ran.events = stored.events;
  ran.rig = setup.rig;
  return ran;
}

std::vector<std::string> values(const DriftRun& ran, const std::string& kind) {
  std::vector<std::string> found;
  for (const auto& event : ran.events)
    if (event.kind == kind) found.push_back(event.value);
  return found;
}

}  // namespace

TEST_CASE("a thermometer is found by its name, and by its device if the name is not enough",
          "[session][drift]") {
  Sensors sensors;
  const std::string root = sensors.folder.path;
  sensors.set("hwmon1", 25.5);
  CHECK(system::read_thermometer_C(system::find_thermometer("hwmon:lm75@1-0049/temp1", root)) == 25.5);
  CHECK(system::read_thermometer_C(system::find_thermometer("hwmon:cpu_thermal/temp1", root)) == 23);
  CHECK_THROWS_WITH(system::find_thermometer("hwmon:lm75/temp1", root),
                    Catch::Matchers::ContainsSubstring("2 temperature sensors fit") &&
                        Catch::Matchers::ContainsSubstring("lm75@1-0048"));
  CHECK_THROWS_WITH(system::find_thermometer("hwmon:tmp117/temp1", root),
                    Catch::Matchers::ContainsSubstring("0 temperature"));
  sensors.set("hwmon1", 250);  // 250 degrees: a sensor that is not connected
  CHECK_FALSE(
      system::read_thermometer_C(system::find_thermometer("hwmon:lm75@1-0049/temp1", root)).has_value());
}

TEST_CASE("a thermometer of the subsystem IIO is read, whether or not the kernel computes the temperature",
          "[session][drift]") {
  TemporaryFolder folder;
  const auto device = [&](const std::string& number, const std::string& parent, const std::string& name) {
    const auto at = std::filesystem::path(folder / "devices") / parent / number;
    std::filesystem::create_directories(at);
    std::filesystem::create_directories(folder / "iio");
    std::filesystem::create_directory_symlink(at, std::filesystem::path(folder / "iio") / number);
    std::ofstream(at / "name") << name << "\n";
    return at;
  };
  const auto ir = device("iio:device0", "1-005a", "mlx90614"),
             plain = device("iio:device1", "1-0048", "tmp117"),
             other = device("iio:device2", "1-0049", "tmp117");
  std::ofstream(ir / "in_temp_object_raw") << 14908;
  std::ofstream(ir / "in_temp_object_scale") << 20;
  std::ofstream(ir / "in_temp_object_offset") << -13657.5;
  std::ofstream(plain / "in_temp_input") << 23500;
  std::ofstream(other / "in_temp_raw") << 3000;
  std::ofstream(other / "in_temp_scale") << 7.8125;
  const std::string root = folder / "iio";
  const auto degrees = [&](const std::string& uri) {
    return system::read_thermometer_C(system::find_thermometer(uri, "/nowhere", root)).value_or(-1);
  };
  CHECK(degrees("iio:mlx90614/temp_object") == Approx(25.01));
  CHECK(degrees("iio:tmp117@1-0048/temp") == Approx(23.5));
  CHECK(degrees("iio:tmp117@1-0049/temp") == Approx(23.4375));
  CHECK_THROWS_WITH(degrees("iio:tmp117/temp"),
                    Catch::Matchers::ContainsSubstring("2 temperature sensors fit") &&
                        Catch::Matchers::ContainsSubstring("tmp117@1-0049"));
  CHECK_THROWS_WITH(degrees("iio:mlx90614/temp"), Catch::Matchers::ContainsSubstring("0 temperature"));
  std::ofstream(other / "in_temp_scale") << "?";
  CHECK(degrees("iio:tmp117@1-0049/temp") == -1);
}

TEST_CASE("temperatures of plate and frame are logged, and a change of 3 K is flagged once",
          "[session][drift]") {
  Sensors sensors;
  const auto ran = run_warm(3.5, sensors, kThermometers);
  CHECK(values(ran, "temperature").size() == ran.trials.size());
  CHECK(values(ran, "temperature").front() == "plate 23 C, frame 23 C");
  CHECK(values(ran, "temperature").back() == "plate 26.5 C, frame 23 C");
  CHECK(values(ran, "temperature_flag") ==
        std::vector<std::string>{"the plate changed by 3.5 K since the session began"});
  Sensors cooler;
  CHECK(values(run_warm(2.5, cooler, kThermometers), "temperature_flag").empty());
}

TEST_CASE("after 10 K, corrected frequencies put each boundary where it was planned to 0.05 mm",
          "[session][drift]") {
  Sensors sensors;
  const auto cold = run_warm(0, sensors), warm = run_warm(10, sensors);
  CHECK(values(cold, "drift").empty());
  const auto said = values(warm, "drift");
  REQUIRE(said.size() == 1);
  CHECK(said[0].find("frequencies are corrected") != std::string::npos);
  CHECK(warm.resonance == Approx(1 - 0.5 * 4.57e-4 * 10).epsilon(1e-6));
  REQUIRE(warm.trials.size() == cold.trials.size());
  const auto surface = rig::surface_of(warm.rig);
  for (std::size_t k = 0; k < warm.trials.size(); ++k) {
    const auto& trial = warm.trials[k];
    CHECK(trial.outcome == core::Outcome::answered);
    for (std::size_t t = 0; t < trial.tones.size(); ++t) {
      // The warm plate has the boundary of a tone where a cold plate has that of the tone's frequency divided
      // by `resonance`, the factor by which warming changes the resonances.
      const auto planned = physics::turning_point_m(surface, cold.trials[k].tones[t].frequency_Hz);
      const auto now = physics::turning_point_m(
          surface, trial.tones[t].frequency_Hz / (trial.trial_index < 2 ? 1 : warm.resonance));
      const double off_mm = 1e3 * std::abs(now.value() - planned.value());
      INFO("trial " << trial.trial_index << ": " << off_mm << " mm");
      if (trial.trial_index == 2)
        CHECK(off_mm > 0.2);  // in the trial that found the drift, the frequencies were not corrected yet
      else
        CHECK(off_mm < 0.05);
    }
    if (trial.trial_index > 2) CHECK(trial.surface.proof == core::Proof::ok);
  }
}

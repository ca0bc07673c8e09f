#include <cmath>
#include <fstream>
#include <map>
#include <random>

#include "station/core/usage_error.hpp"
#include "station/maintenance/force_weights.hpp"
#include "station/maintenance/panel_latency.hpp"
#include "station/rig/apply.hpp"
#include "station/session/simulated_room.hpp"
#include "station/simulation/cells.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"

using namespace turnpoint;
using maintenance::open_bridges;
using maintenance::weigh;
using maintenance::WeightStep;

namespace {

const auto kReady = [](const WeightStep&) { return true; };
const auto kGiveUp = [](const core::Phrase&) { return false; };

/// Returns each cell's ratio of bridge to reference under a load, from the formulas in simulation/setup.hpp.
sensing::Readings readings(const simulation::Setup& room, const simulation::Load& load) {
  const auto& w = room.wires;
  const double per_N = room.cells.volt_per_volt_N * w.gain * w.reference_V_at_full_scale / w.full_scale_V;
  const auto forces = simulation::forces_on(room.cells, load);
  sensing::Readings made{};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t k = 0; k < 3; ++k) made[c] += per_N * room.cells.crosstalk[c][k] * forces[k];
  return made;
}

std::string failure(const rig::Rig& rig, const std::function<void(simulation::Setup&)>& laboratory) {
  try {
    weigh(rig, *open_bridges(rig, laboratory), kReady, kGiveUp);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

/// A bridge reader with exact readings. At reading number `fails_at`, a wire is off.
struct ExactBridges : maintenance::BridgeReader {
  simulation::Setup room;
  int reads = 0, fails_at = -1;
  std::function<void(WeightStep&, int)> mistake = [](auto&, int) {};  ///< a mistake of the operator
  std::function<double(int read)> noise = [](int) { return 0.0; };
  double creep_N = 0;  ///< the zero of cell a moves by this much at each reading
  maintenance::BridgeReading read(const WeightStep& asked) override {
    auto step = asked;
    mistake(step, reads);
    if (reads++ == fails_at) throw std::runtime_error("cell b on captured channel 2: a wire is off");
    maintenance::BridgeReading made;
    made.ratio = readings(room, {9.81e-3 * step.mass_g, 9.81e-3 * step.pull_g, 1e-3 * step.position_mm});
    made.ratio[0] += 0.057 * creep_N * reads;
    made.reference = 0.4;
    made.sd.fill(noise(reads - 1));
    return made;
  }
};

}  // namespace

TEST_CASE("dead weights in the simulated room calibrate forces to 0.1 % and positions to 0.2 mm",
          "[maintenance][forces]") {
  const TemporaryFolder folder;
  const auto path = measured::with_capture(folder, measured::kCells);
  const auto rig = rig::load(path);
  const auto result = weigh(rig, *open_bridges(rig), kReady, kGiveUp);
  CHECK(result.steps.size() == 32);
  CHECK(result.zero_moved_mN < 0.5);
  for (const auto& rest : result.residuals) {
    CHECK(std::abs(rest.normal_N) < 1e-3);
    CHECK(std::abs(rest.position_mm) < 1);
  }
  session::SimulatedRoom room(rig);
  const auto& setup = room.plant().setup();
  const sensing::ForceCalibration calibration(result.cells.matrix, result.cells.changes);
  for (const double x_m : {0.06, 0.15, 0.24})
    for (const double pull_N : {-0.4, 0.0, 0.4}) {
      const auto force = calibration.force(readings(setup, {0.5, pull_N, x_m}));
      CHECK(force.normal_N == Approx(0.5).epsilon(1e-3));
      CHECK(force.lateral_N == Approx(pull_N).margin(0.003));
      CHECK(force.moment_Nmm / force.normal_N == Approx(1e3 * x_m).margin(0.2));
    }
  auto made = maintenance::known_calibration(rig);
  made.forces = result.cells;
  const auto again = rig::parse_calibration(rig::to_toml(made), "a.toml").forces.value();
  CHECK(again.matrix == result.cells.matrix);
  CHECK(again.changes == result.cells.changes);
  CHECK(again.rated_ratio == result.cells.rated_ratio);
  CHECK(again.usable_Hz == result.cells.usable_Hz);
}

TEST_CASE("taps on the plate show up to which frequency forces are right", "[maintenance][forces][tap]") {
  const TemporaryFolder folder;
  const auto rig = rig::load(measured::with_capture(folder, measured::kCells));
  const auto with = [&](double normal_Hz, double lateral_Hz, double damping) {
    const auto laboratory = [&](simulation::Setup& room) {
      room.cells.normal_Hz = normal_Hz, room.cells.lateral_Hz = lateral_Hz, room.cells.damping = damping;
    };
    return weigh(rig, *open_bridges(rig, laboratory), kReady, [](const core::Phrase&) { return true; });
  };
  const auto usual = with(56, 180, 0.05);
  CHECK(usual.resonance_Hz.value() == Approx(56).epsilon(0.02));
  CHECK(usual.cells.usable_Hz.value() == Approx(usual.resonance_Hz.value() / 3));
  CHECK(with(150, 90, 0.02).cells.usable_Hz.value() == Approx(30).epsilon(0.02));
  CHECK_FALSE(with(56, 180, 2).cells.usable_Hz);

  int asked = 0;
  const auto without_taps = [&](const WeightStep& step) {
    asked += step.tap == maintenance::Tap::none ? 0 : 1;
    return step.tap == maintenance::Tap::none;
  };
  CHECK_FALSE(weigh(rig, *open_bridges(rig), without_taps, kGiveUp).cells.usable_Hz);
  CHECK(asked == 2);
}

TEST_CASE("what is wrong with the cells or their wires is named", "[maintenance][forces]") {
  const TemporaryFolder folder;
  const auto rig = rig::load(measured::with_capture(folder, measured::kCells));
  CHECK(failure(rig, [](simulation::Setup& room) {
          room.wires.carrier_channel = std::nullopt;
        }).find("the reference on captured channel 0 carries no excitation") != std::string::npos);
  CHECK(failure(rig, [](simulation::Setup& room) {
          room.cells.zero_N[1] = 25;
        }).find("cell b on captured channel 2") != std::string::npos);
  CHECK(failure(rig, [](simulation::Setup& room) {
          room.cells.crosstalk[2] = {0, 0, 0};
        }).find("cell lateral does not respond") != std::string::npos);
  const auto plain = rig::load(measured::with_capture(folder, measured::kPickUps));
  CHECK_THROWS_AS(open_bridges(plain), core::UsageError);
}

TEST_CASE("a failed reading can be repeated, steps can be left out, and a moving zero is refused",
          "[maintenance][forces]") {
  const TemporaryFolder folder;
  const auto rig = rig::load(measured::with_capture(folder, measured::kCells));
  ExactBridges bridges;
  bridges.room.cells.span_m = rig.surface.length_m;
  bridges.fails_at = 5;
  std::string why;
  const auto repeated = weigh(rig, bridges, kReady, [&](const core::Phrase& reason) {
    why = core::say(reason, "en");
    return true;
  });
  CHECK(why.find("cell b") != std::string::npos);
  CHECK(repeated.steps.size() == 32);
  for (const auto& rest : repeated.residuals) CHECK(std::abs(rest.normal_N) < 1e-9);
  bridges.reads = 0;
  CHECK_THROWS_WITH(weigh(rig, bridges, kReady, kGiveUp), Catch::Matchers::ContainsSubstring("cell b"));
  bridges.fails_at = -1;
  const auto some = [](const WeightStep& step) { return step.tare || step.mass_g == 200; };
  CHECK(weigh(rig, bridges, some, kGiveUp).steps.size() == 17);
  CHECK_THROWS_AS(weigh(
                      rig, bridges, [](const WeightStep& step) { return step.tare; }, kGiveUp),
                  core::UsageError);
  bridges.creep_N = 5e-3;
  CHECK_THROWS_WITH(weigh(rig, bridges, kReady, kGiveUp),
                    Catch::Matchers::ContainsSubstring("the zero of the cells moved"));
}

TEST_CASE("a weight that does not agree with the others is named and weighed again",
          "[maintenance][forces]") {
  const TemporaryFolder folder;
  const auto rig = rig::load(measured::with_capture(folder, measured::kCells));
  ExactBridges bridges;
  bridges.room.cells.span_m = rig.surface.length_m;
  const bool always = GENERATE(false, true);
  const auto [change, said] = GENERATE(table<std::function<void(WeightStep&)>, std::string>(
      {{[](WeightStep& step) { step.mass_g = 100; },
        "according to them, it is 100 g at 90 mm with a pull of 0 g"},
       {[](WeightStep& step) { step.position_mm = 100; },
        "according to them, it is 50 g at 100 mm with a pull of 0 g"},
       {[](WeightStep& step) { step.pull_g = 5; },
        "according to them, it is 50 g at 90 mm with a pull of 5 g"}}));
  bridges.mistake = [&](WeightStep& step, int read) {
    if (step.mass_g == 50 && step.position_mm == Approx(90) && (always || read < 32)) change(step);
  };
  std::vector<std::string> remarks;
  const auto asked = [&](const WeightStep& step) {
    if (!step.remark.empty() && !step.tare) remarks.push_back(core::say(step.remark, "en"));
    return true;
  };
  const auto why = "50 g at 90 mm does not agree with the other weights: " + said;
  if (always) {
    CHECK_THROWS_WITH(weigh(rig, bridges, asked, kGiveUp), Catch::Matchers::StartsWith(why));
  } else {
    const auto made = weigh(rig, bridges, asked, kGiveUp);
    REQUIRE(made.repeated.size() == 1);
    CHECK(core::say(made.repeated[0].name(), "en") == "50 g at 90 mm");
    CHECK(made.steps.size() == 32);
    for (const auto& rest : made.residuals) CHECK(std::abs(rest.position_mm) < 1e-6);
  }
  REQUIRE(remarks.size() == 1);
  CHECK_THAT(remarks[0], Catch::Matchers::StartsWith(why));
}

TEST_CASE("a forgotten string, a swinging weight and a shaken table are refused", "[maintenance][forces]") {
  const TemporaryFolder folder;
  const auto rig = rig::load(measured::with_capture(folder, measured::kCells));
  ExactBridges bridges;
  bridges.room.cells.span_m = rig.surface.length_m;
  bridges.mistake = [](WeightStep& step, int) { step.pull_g = 0; };
  CHECK_THROWS_WITH(weigh(rig, bridges, kReady, kGiveUp), Catch::Matchers::ContainsSubstring("string"));
  bridges.mistake = [](auto&, int) {};
  bridges.reads = 0;
  bridges.noise = [](int read) { return read == 7 ? 1.2e-4 : 1e-5; };
  CHECK_THROWS_WITH(weigh(rig, bridges, kReady, kGiveUp),
                    Catch::Matchers::ContainsSubstring("cell a did not rest: it varied 12 times"));
  bridges.reads = 0;
  bridges.noise = [](int) { return 2.5e-3 * 0.057; };
  CHECK_THROWS_WITH(weigh(rig, bridges, kReady, kGiveUp),
                    Catch::Matchers::ContainsSubstring("are not steady without a weight"));
}

TEST_CASE("the stated uncertainty is that of the places, the masses and the pulley",
          "[maintenance][forces]") {
  const TemporaryFolder folder;
  const auto rig = rig::load(measured::with_capture(folder, measured::kCells));
  ExactBridges bridges;
  bridges.room.cells.span_m = rig.surface.length_m;
  const auto exact = weigh(rig, bridges, kReady, kGiveUp);
  // Makes many calibrations, each with errors of the sizes in sensing::WeightErrors, and lets each one
  // measure a finger in the middle of the surface that presses with 0.5 N and pulls along it with 0.25 N.
  std::mt19937 random(1);
  std::normal_distribution<double> unit;
  double position2 = 0, friction2 = 0;
  constexpr int times = 200;
  for (int n = 0; n < times; ++n) {
    std::map<long, double> places;
    const std::array pulleys{0.01 * unit(random), 0.01 * unit(random)};
    bridges.mistake = [&](WeightStep& step, int) {
      const auto [at, is_new] = places.try_emplace(std::lround(step.position_mm), 0.0);
      if (is_new) at->second = 0.2 * unit(random);
      step.position_mm += at->second;
      step.pull_g *= 1 + pulleys[step.pull_g > 0 ? 0 : 1];
    };
    const auto cells = weigh(rig, bridges, kReady, kGiveUp).cells;
    const sensing::ForceCalibration calibration(cells.matrix, cells.changes);
    const auto force = calibration.force(readings(bridges.room, {0.5, 0.25, 0.5 * rig.surface.length_m}));
    position2 += std::pow(force.moment_Nmm / force.normal_N - 500 * rig.surface.length_m, 2) / times;
    friction2 += std::pow(force.lateral_N / force.normal_N - 0.5, 2) / times;
  }
  CHECK(exact.sd.position_mm == Approx(std::sqrt(position2)).epsilon(0.2));
  CHECK(exact.sd.friction == Approx(std::sqrt(friction2)).epsilon(0.2));
}

TEST_CASE("a session measures forces with the calibration that dead weights gave", "[maintenance][forces]") {
  const TemporaryFolder folder;
  const auto path = measured::with_capture(folder, measured::kCells);
  const auto rig = rig::load(path);
  ExactBridges bridges;
  bridges.room = session::laboratory_of(rig);
  auto made = maintenance::known_calibration(rig);
  made.forces = weigh(rig, bridges, kReady, kGiveUp).cells;
  // ExactBridges has another amplitude of the carrier than the simulated room.
  const auto& wires = bridges.room.wires;
  made.forces->reference_amplitude =
      session::kCarrier * wires.excitation_V_per_full_scale / wires.reference_V_at_full_scale;
  const auto mean_force = [&](double factor) {
    auto changed = made;
    for (auto& row : changed.forces->matrix)
      for (double& value : row) value *= factor;
    const auto file = folder / "forces.toml";
    std::ofstream(file) << rig::to_toml(changed);
    auto request =
        simulated_run(measured::shipped("demo"), folder / ("a" + std::to_string(factor) + ".sqlite"), 7);
    request.rig = path;
    request.calibration = file;
    session::Inputs inputs;
    const auto summary = session::run(session::prepare(request), nullptr, inputs);
    double sum = 0, count = 0;
    for (const auto& block : store::read_session(request.database, summary.session_id).blocks)
      for (const auto& trial : block.trials)
        if (trial.finger.normal_N) sum += *trial.finger.normal_N, ++count;
    REQUIRE(count > 5);
    return sum / count;
  };
  const double right = mean_force(1);
  CHECK(right == Approx(0.5).margin(0.08));
  CHECK(mean_force(2) == Approx(2 * right).epsilon(0.02));
}

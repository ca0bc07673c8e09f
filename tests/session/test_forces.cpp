#include <cmath>

#include "station/analysis/quantile.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace measured;

namespace {

/// Writes the demo protocol with other values of some keys.
std::string demo_with(const TemporaryFolder& folder,
                      const std::vector<std::pair<std::string, std::string>>& changes) {
  std::ostringstream text;
  text << std::ifstream(shipped("demo")).rdbuf();
  auto protocol = text.str();
  for (const auto& [from, to] : changes) {
    const auto at = protocol.find(from);
    REQUIRE(at != std::string::npos);
    protocol.replace(at, from.size(), to);
  }
  const auto path = folder / "demo.toml";
  std::ofstream(path) << protocol;
  return path;
}

}  // namespace

TEST_CASE("force cells measure the finger in each trial, and the stimuli are still proven",
          "[session][forces]") {
  simulation::Truth truth;
  const auto ran =
      run(shipped("demo"), [&](int, simulation::Plant& plant) { truth = plant.truth(); }, {kCells});
  REQUIRE(ran.trials.size() == 10);
  for (const auto& trial : ran.trials) {
    CHECK(trial.outcome == core::Outcome::answered);
    CHECK(trial.surface.proof == core::Proof::ok);
    const auto& finger = trial.finger;
    CHECK(finger.sensing == "ok");
    CHECK(finger.contact_s.value() > 0.5);
    CHECK(finger.strokes.value() >= 0);
    if (finger.strokes.value() == 0) continue;
    CHECK(finger.normal_N.value() == Approx(0.5).margin(0.15));
    CHECK(finger.speed_mm_s.value() == Approx(128).margin(12));
    CHECK(std::abs(finger.tare_mN.value()) < 1);
  }
}

TEST_CASE("the step of friction is felt where the plan puts it, on average to 0.2 mm", "[session][forces]") {
  TemporaryFolder folder;
  const auto protocol = demo_with(folder, {{"edge = \"p50\"", "edge = { friction = 0.55 }"},
                                           {"displacement_um = 1.0", "displacement_um = 3.0"},
                                           {"explore_s = 4.0", "explore_s = 20.0"},
                                           {"deadline_s = 6.0", "deadline_s = 25.0"},
                                           {"repeats = 2", "repeats = 4"}});
  How how{kCells};
  // the simulated participant answers late, because an answer ends the stimulus
  how.observer = "sim:residual=18";
  const auto ran = run(
      protocol, [](int, simulation::Plant&) {}, how);
  REQUIRE(ran.trials.size() == 20);
  std::vector<double> shift_mm;
  for (const auto& trial : ran.trials) {
    const auto& finger = trial.finger;
    INFO("planned " << trial.presented.boundary_mm.value());
    REQUIRE(finger.boundary_felt_mm);
    shift_mm.push_back(finger.boundary_felt_mm.value() - trial.presented.boundary_mm.value());
    CHECK(std::abs(shift_mm.back()) < 1);
    CHECK(finger.boundary_se_mm.value() < 1);
    CHECK(finger.mu_high.value() == Approx(0.8).epsilon(0.1));  // the finger's friction at rest
    CHECK(finger.mu_low.value() < 0.4);
  }
  const auto trials = static_cast<double>(shift_mm.size());
  const double mean = analysis::mean(shift_mm), sd = std::sqrt(analysis::variance(shift_mm));
  const double half_interval = analysis::student_t_975(static_cast<int>(trials) - 1) * sd / std::sqrt(trials);
  INFO("mean " << mean << " +- " << half_interval << ", sd " << sd);
  CHECK(std::abs(mean) + half_interval < 0.2);
  CHECK(sd < 0.5);
}

TEST_CASE("the felt boundary is measured at the planned level of friction, here far from half-way",
          "[session][forces]") {
  TemporaryFolder folder;
  const auto protocol = demo_with(folder, {{"edge = \"p50\"", "edge = { friction = 0.8 }"},
                                           {"displacement_um = 1.0", "displacement_um = 3.0"},
                                           {"explore_s = 4.0", "explore_s = 20.0"},
                                           {"deadline_s = 6.0", "deadline_s = 25.0"},
                                           {"repeats = 2", "repeats = 1"}});
  How how{kCells};
  how.observer = "sim:residual=18";
  const auto ran = run(
      protocol, [](int, simulation::Plant&) {}, how);
  REQUIRE(ran.trials.size() == 5);
  // The margin excludes the place half-way up the step, which is some 4 mm away.
  for (const auto& trial : ran.trials)
    CHECK(trial.finger.boundary_felt_mm.value() == Approx(trial.presented.boundary_mm.value()).margin(1.2));
}

TEST_CASE("a trial whose forces are not known says why", "[session][forces]") {
  using simulation::FaultKind;
  const auto [kind, why] = GENERATE(std::pair{FaultKind::no_reference, std::string("wire")},
                                    std::pair{FaultKind::broken_bridge, std::string("wire")},
                                    std::pair{FaultKind::dead_bridge, std::string("wire")});
  const auto ran = run(shipped("demo"),
                       [kind = kind](int trial, simulation::Plant& plant) {
                         if (trial == 3)
                           plant.add({kind, plant.frames() + 192000, simulation::kNever, {}, 0});
                       },
                       {kCells});
  INFO(why);
  REQUIRE(ran.trials.size() >= 10);
  for (const auto& trial : ran.trials) {
    CHECK(trial.finger.sensing == (trial.trial_index == 3 ? why : "ok"));
    CHECK(trial.finger.normal_N.has_value() == (trial.trial_index != 3));
  }
}

TEST_CASE("something that lies on the surface before a trial is reported", "[session][forces]") {
  const auto ran = run(shipped("demo"),
                       [](int trial, simulation::Plant& plant) {
                         plant.set_load(trial == 4 ? simulation::Load{0.05, 0, 0.1} : simulation::Load{});
                       },
                       {kCells});
  for (const auto& trial : ran.trials)
    CHECK(trial.finger.sensing == (trial.trial_index == 4 ? "tare" : "ok"));
}

TEST_CASE("without force cells nothing is said about the finger", "[session][forces]") {
  const auto ran = run(shipped("demo"), [](int, simulation::Plant&) {});
  for (const auto& trial : ran.trials) {
    CHECK(trial.finger.sensing.empty());
    CHECK_FALSE(trial.finger.contact_s.has_value());
  }
}

TEST_CASE("a trial with another movement than the protocol asks for is repeated, then marked",
          "[session][forces]") {
  TemporaryFolder folder;
  const auto protocol = demo_with(folder, {{"repeats = 2\n", "repeats = 1\n"},
                                           {"[timing]",
                                            "[sensing]\nspeed_mm_s = [200, 300]\nstrokes = 1\n"
                                            "outside = \"repeat\"\nrepeats = 4\n[timing]"},
                                           {"explore_s = 4.0", "explore_s = 20.0"},
                                           {"deadline_s = 6.0", "deadline_s = 25.0"}});
  How how{kCells};
  how.observer = "sim:residual=4";
  const auto ran = run(
      protocol, [](int, simulation::Plant&) {}, how);
  REQUIRE(ran.trials.size() == 25);
  CHECK(ran.summary.answered == 5);
  for (std::size_t i = 0; i < ran.trials.size(); ++i) {
    const auto& trial = ran.trials[i];
    CHECK(trial.finger.sensing == "slow");
    CHECK(trial.finger.speed_in_window.value() < 0.1);
    CHECK_FALSE(trial.finger.normal_in_window.has_value());
    CHECK(trial.outcome == (i % 5 == 4 ? core::Outcome::answered : core::Outcome::fault));
    CHECK(trial.given.response.has_value() == (i % 5 == 4));
    CHECK(trial.level == ran.trials[i / 5 * 5].level);
  }
  for (const auto& said : ran.messages) CHECK(said == "Slide a little faster");
  CHECK(ran.messages.size() == 20);
}

TEST_CASE("a trial with the movement that the protocol asks for counts", "[session][forces]") {
  TemporaryFolder folder;
  const auto protocol =
      demo_with(folder, {{"[timing]",
                          "[sensing]\nspeed_mm_s = [20, 300]\nnormal_N = [0.1, 2]\nstrokes = 1\n"
                          "outside = \"repeat\"\n[timing]"},
                         {"explore_s = 4.0", "explore_s = 20.0"},
                         {"deadline_s = 6.0", "deadline_s = 25.0"},
                         {"repeats = 2\n", "repeats = 1\n"}});
  How how{kCells};
  how.observer = "sim:residual=4";
  const auto ran = run(
      protocol, [](int, simulation::Plant&) {}, how);
  REQUIRE(ran.trials.size() == 5);
  for (const auto& trial : ran.trials) {
    CHECK(trial.finger.sensing == "ok");
    CHECK(trial.finger.normal_in_window.value() > 0.8);
  }
  CHECK(ran.messages.empty());
}

TEST_CASE("a rig without force cells refuses a protocol that asks for a movement", "[session][forces]") {
  TemporaryFolder folder;
  const auto protocol = demo_with(folder, {{"[timing]", "[sensing]\nstrokes = 1\n[timing]"}});
  CHECK_THROWS_WITH(run(protocol, [](int, simulation::Plant&) {}),
                    Catch::Matchers::ContainsSubstring("the rig has no force cells"));
}

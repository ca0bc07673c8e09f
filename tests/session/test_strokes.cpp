#include <cmath>
#include <map>
#include <sstream>

#include "station/session/resume.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

// Tests of blocks in which the finger strokes the surface and nothing is asked: training, and measuring the
// friction table.

using namespace turnpoint;
using namespace measured;

namespace {

/// Returns a protocol with these blocks, followed by one trial that asks for a relative friction of 0.6.
std::string protocol_with(const TemporaryFolder& folder, const std::string& blocks,
                          const std::string& sensing = "strokes = 1") {
  const auto path = folder / "strokes.toml";
  std::ofstream(path) << R"(format = "friction-protocol/1"
[protocol]
id = "strokes"
version = "1.0.0"
title = "Strokes"
languages = ["en"]
[[factor]]
name = "side"
range = [-1.0, 1.0]
[scene.edge]
boundary_mm = 185.0
edge = "p50"
friction = 0.6
[scene.smooth]
boundary_mm = 185.0
edge = "p50"
zone = { from_mm = 60.0, friction = 0.5, tones = 3 }
[task]
kind = "single-interval"
intervals = ["edge"]
device = "touch"
question = { en = "Left or right?" }
choices = [ { id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } } ]
correct = { left = "side < 0", right = "side > 0" }
[sensing]
)" << sensing << R"(
[timing]
response_zero = "go_cue"
explore_s = 3.0
deadline_s = 6.0
iti_s = 0.5
[[procedure]]
name = "levels"
kind = "constant-stimuli"
level = "side"
values = [-1.0, 1.0]
repeats = 1
)" << blocks << R"(
[[block]]
name = "main"
procedures = ["levels"]
)";
  return path;
}

const char* const kTable =
    "[[block]]\nname = \"finger\"\nkind = \"friction-table\"\nscene = \"smooth\"\nfrom_mm = 90\n"
    "to_mm = 160\ndisplacement_um = [0.3, 0.6, 1.0, 1.6]\nrepeats = 3\nduration_s = 3.0\nuse = ";
const char* const kTraining =
    "[[block]]\nname = \"training\"\nkind = \"training\"\nstrokes = 5\nduration_s = 4.0\n"
    "pass = { strokes = 4, retries = 1 }\n";

/// Returns the friction map of a finger that needs twice the vibration of the rig's curve.
physics::FrictionMap stiff_finger() {
  const physics::FrictionMap rig{physics::LoadSharing{}};
  std::vector<physics::FrictionPoint> points;
  // The curve ends where it no longer falls.
  for (int k = 0; k <= 100; ++k) {
    const double friction = rig.relative_friction(0.025e-6 * k);
    if (k > 0 && points.back().relative_friction - friction < 1e-4) break;
    points.push_back({0.05e-6 * k, friction, 0});
  }
  return physics::FrictionMap(points);
}

How with_finger(const physics::FrictionMap& friction, double drift_per_s = 0) {
  How how{kCells};
  how.room = [=](simulation::Setup& room) {
    room.friction = friction;
    room.finger.friction_drift_per_s = drift_per_s;
  };
  return how;
}

const core::EventRow& table_of(const Ran& ran) {
  for (const auto& event : ran.events)
    if (event.kind == "friction_table") return event;
  throw std::runtime_error("no friction table is stored");
}

const auto nothing = [](int, simulation::Plant&) {};

}  // namespace

TEST_CASE("a session measures how much vibration reduces the friction of this finger, although it drifts",
          "[session][strokes]") {
  TemporaryFolder folder;
  const auto finger = stiff_finger();
  const auto ran = run(protocol_with(folder, std::string(kTable) + "true\n"), nothing,
                       with_finger(finger, 0.3 / 120));  // friction drifts by 30 % within two minutes
  REQUIRE(ran.summary.status == core::SessionStatus::completed);
  REQUIRE(ran.trials.size() == 27);
  const auto& table = table_of(ran);
  REQUIRE(table.friction_levels.size() == 4);
  double squares = 0;
  for (const auto& level : table.friction_levels) {
    const double truth = finger.relative_friction(1e-6 * level.displacement_um);
    INFO(level.displacement_um << " um: " << level.relative_friction << " +- " << level.sd << ", truth "
                               << truth);
    CHECK(level.trials == 3);
    CHECK(level.relative_friction == Approx(truth).epsilon(0.15));
    CHECK(level.low < level.relative_friction);
    CHECK(level.relative_friction <= level.high);
    squares += std::pow(level.relative_friction / truth - 1, 2);
  }
  CHECK(std::sqrt(squares / 4) < 0.08);
  SECTION("the strokes at rest are between all others") {
    for (std::size_t i = 0; i < 25; ++i) {
      const auto& trial = ran.trials[i];
      CHECK((trial.level.value() == 0) == (i % 2 == 0));
      CHECK(trial.tones.empty() == (i % 2 == 0));
      CHECK(trial.type == core::TrialType::practice);
      CHECK(trial.given.response == "ok");
      CHECK_FALSE(trial.given.correct);
    }
    // the friction of the same finger has drifted
    CHECK(ran.trials[24].finger.mu.value() / ran.trials[0].finger.mu.value() > 1.15);
  }
}

TEST_CASE("trials are planned with the measured table where the protocol asks for it", "[session][strokes]") {
  TemporaryFolder folder;
  const physics::FrictionMap rig{physics::LoadSharing{}};
  const auto strength_um = [&](const std::string& use) {
    const auto ran =
        run(protocol_with(folder, std::string(kTable) + use), nothing, with_finger(stiff_finger()));
    REQUIRE(ran.trials.size() == 27);
    return ran.trials.back().presented.amplitude.value();
  };
  const double by_rig = strength_um("false\n"), by_table = strength_um("true\n");
  // this finger needs twice the vibration, as the measured table must show
  CHECK(by_table / by_rig == Approx(2).epsilon(0.1));
}

TEST_CASE("a resumed session continues the table, and plans with the same table afterwards",
          "[session][strokes]") {
  TemporaryFolder folder;
  auto request = request_in(folder, protocol_with(folder, std::string(kTable) + "true\n"));
  // Runs the session, and stops it before trial `stop_at`.
  const auto run_once = [&](session::Setup setup, int stop_at) {
    auto room = std::make_unique<session::SimulatedRoom>(setup.rig, with_finger(stiff_finger()).room);
    Saboteur saboteur;
    session::Inputs inputs;
    saboteur.before = [](int) {};
    saboteur.after = [&](int done) {
      if (done + 1 == stop_at) inputs.push({0, session::input::Stop{}});
    };
    Pages pages;
    return session::run(setup, &pages, inputs, std::move(room), &saboteur);
  };
  const auto stop_at = GENERATE(12, 26);
  CHECK(run_once(session::prepare(request), stop_at).status == core::SessionStatus::interrupted);
  std::ostringstream messages;
  auto resumed = session::prepare_resume({request.database, "", "resume", true}, messages);
  REQUIRE(resumed);
  resumed->protocol.resume.warmup = 0;
  const auto summary = run_once(*resumed, -1);
  CHECK(summary.status == core::SessionStatus::completed);
  const auto stored = store::read_session(request.database, summary.session_id);
  int tables = 0;
  std::vector<core::TrialRow> trials;
  for (const auto& event : stored.events) tables += event.kind == "friction_table" ? 1 : 0;
  for (const auto& block : stored.blocks)
    trials.insert(trials.end(), block.trials.begin(), block.trials.end());
  CHECK(tables == 1);
  REQUIRE(trials.size() == 27);
  // If the resumed session used the rig's curve instead of the measured table, the last trials would be half
  // as strong.
  request.database = folder / "whole.sqlite";
  const auto whole = run_once(session::prepare(request), -1);
  const auto reference = store::read_session(request.database, whole.session_id);
  const auto& last = reference.blocks.back().trials.back();
  CHECK(trials.back().presented.amplitude.value() == Approx(last.presented.amplitude.value()).epsilon(0.1));
}

TEST_CASE("a training is passed by the movement that the protocol asks for, and only by it",
          "[session][strokes]") {
  TemporaryFolder folder;
  const auto protocol =
      protocol_with(folder, kTraining, "normal_N = [0.3, 0.8]\nstrokes = 1\noutside = \"repeat\"");
  How how{kCells};
  SECTION("the usual finger") {
    const auto ran = run(protocol, nothing, how);
    CHECK(ran.summary.status == core::SessionStatus::completed);
    REQUIRE(ran.trials.size() == 7);
    for (std::size_t i = 0; i < 5; ++i) {
      CHECK(ran.trials[i].given.response == "ok");
      CHECK(ran.trials[i].given.correct == true);
      CHECK(ran.trials[i].tones.empty());
    }
  }
  SECTION("a finger that presses too hard") {
    how.room = [](simulation::Setup& room) { room.finger.normal_N = 1.6; };
    const auto ran = run(protocol, nothing, how);
    CHECK(ran.summary.status == core::SessionStatus::stopped);
    CHECK(ran.summary.reason == "practice \"training\" was not passed in 2 attempts");
    REQUIRE(ran.trials.size() == 10);
    for (const auto& trial : ran.trials) {
      CHECK(trial.given.response == "hard");
      CHECK(trial.given.correct == false);
      CHECK(trial.outcome == core::Outcome::answered);
    }
  }
}

TEST_CASE("a stroke whose forces are not known is made again", "[session][strokes]") {
  TemporaryFolder folder;
  const auto ran =
      run(protocol_with(folder, kTraining),
          [](int trial, simulation::Plant& plant) {
            if (trial == 2)
              plant.add(
                  {simulation::FaultKind::no_reference, plant.frames() + 192000, simulation::kNever, {}, 0});
          },
          {kCells});
  REQUIRE(ran.trials.size() == 8);
  CHECK(ran.trials[2].outcome == core::Outcome::fault);
  CHECK(ran.trials[2].finger.sensing == "wire");
  CHECK(ran.trials[3].outcome == core::Outcome::answered);
}

#include <cmath>

#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

// Tests that sessions prove what the surface does while its tones glide from one scene to another.

using namespace turnpoint;
using namespace measured;
using core::Proof;
using core::ProofCause;

namespace {

/// Two scenes that follow each other in one interval, with a glide of 100 ms after 0.8 s.
std::string changing(const TemporaryFolder& folder, const std::string& after) {
  const auto path = folder / "changing.toml";
  std::ofstream(path) << R"(format = "friction-protocol/1"
[protocol]
id = "changing"
version = "1.0.0"
title = "Changing"
languages = ["en"]
[[factor]]
name = "step"
range = [0.0, 0.4]
[scene.before]
boundary_mm = 185.0
edge = "p50"
zone = { from_mm = 60.0, friction = 0.75, tones = 3 }
[scene.after]
base = "before"
)" << after << R"(
[task]
kind = "single-interval"
intervals = [["before", "after"]]
foreperiod_s = 0.8
transition_ms = 100
device = "touch"
question = { en = "Did it change?" }
choices = [ { id = "yes", label = { en = "Yes" } }, { id = "no", label = { en = "No" } } ]
correct = { yes = "step > 0", no = "step == 0" }
[timing]
response_zero = "change"
explore_s = 2.0
deadline_s = 3.0
iti_s = 0.5
anticipation_s = 0.0
[[procedure]]
name = "levels"
kind = "constant-stimuli"
level = "step"
values = [0.3]
repeats = 4
[[block]]
name = "main"
procedures = ["levels"]
)";
  return path;
}

/// Captured frames from the moment before a trial until its change begins: the simulated room begins 130
/// ms before the onset, and captures what is played 400 frames later.
constexpr std::int64_t kToChange = 24'960 + 153'600;

void halve(simulation::Plant& plant, std::int64_t from, std::int64_t frames) {
  plant.add(
      {simulation::FaultKind::transducer_half, plant.frames() + from, plant.frames() + from + frames, {}, 0});
}

}  // namespace

TEST_CASE("an amplitude that drops while one scene glides to the next is found in its trial",
          "[session][proof][glide]") {
  const TemporaryFolder folder;
  const auto protocol =
      changing(folder, GENERATE("zone = { friction = \"0.75 - 0.75 * step\" }", "boundary_mm = 165.0"));
  const auto fault = GENERATE(true, false);
  CAPTURE(protocol, fault);
  const auto ran = run(protocol, [&](int trial, simulation::Plant& plant) {
    if (trial == 1 && fault) halve(plant, kToChange + 8'000, 3'000);
  });
  REQUIRE(ran.trials.size() == (fault ? 5u : 4u));
  for (const auto& trial : ran.trials) {
    CAPTURE(trial.trial_index, trial.surface.drive_ratio_dB.value_or(99), name(trial.surface.proof_cause));
    if (fault && &trial == &ran.trials[1]) {
      CHECK(trial.outcome == core::Outcome::fault);
      CHECK(trial.surface.proof != Proof::ok);
      CHECK(name(trial.surface.proof_cause) == std::string("level"));
      CHECK(trial.surface.drive_ratio_dB.value() < -3);
    } else {
      CHECK(trial.surface.proof == Proof::ok);
      CHECK(std::abs(trial.surface.drive_ratio_dB.value()) < 0.1);
    }
    for (const auto& tone : trial.tones) {
      CAPTURE(tone.scene_index);
      REQUIRE(tone.measured_dB);
      CHECK(std::abs(*tone.measured_dB) < 0.1);
    }
  }
}

TEST_CASE("an adjustment is proven although the surface glides with the slider", "[session][proof][glide]") {
  const auto fault = GENERATE(false, true);
  const auto ran = run(shipped("boundary-adjustment"), [&](int trial, simulation::Plant& plant) {
    if (trial == 2 && fault) halve(plant, 400'000, 9'600);
  });
  REQUIRE(ran.trials.size() == (fault ? 19u : 18u));
  for (std::size_t k = 0; k < ran.trials.size(); ++k) {
    const auto& trial = ran.trials[k];
    CAPTURE(k, name(trial.surface.proof), name(trial.surface.proof_cause),
            trial.surface.drive_ratio_dB.value_or(99));
    if (fault && k == 2) {
      CHECK(trial.outcome == core::Outcome::fault);
      CHECK(trial.surface.proof != Proof::ok);
      continue;
    }
    CHECK(trial.outcome == core::Outcome::answered);
    CHECK(trial.surface.proof == Proof::ok);
    REQUIRE(trial.tones.size() == 2);
    for (const auto& tone : trial.tones) CHECK(std::abs(tone.measured_dB.value()) < 0.1);
  }
}

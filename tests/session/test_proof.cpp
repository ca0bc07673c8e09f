#include <cmath>

#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace measured;
using terms::Proof;
using terms::ProofCause;

TEST_CASE("without a pick-up a session runs, and each trial is unproven", "[session][proof]") {
  TemporaryFolder folder;
  auto request = request_in(folder, shipped("demo"));
  request.rig = kSource + "/tests/support/thin_plate.toml";
  session::Inputs inputs;
  const auto summary = session::run(setup::prepare(request), nullptr, inputs);
  for (const auto& block : store::read_session(request.database, summary.session_id).blocks)
    for (const auto& trial : block.trials) {
      CHECK(trial.proof == Proof::unproven);
      CHECK_FALSE(trial.drive_ratio_dB.has_value());
    }
}

TEST_CASE("a pick-up proves each trial of a good session", "[session][proof]") {
  const auto ran = run(shipped("demo"), [](int, plant::Plant&) {});
  CHECK(ran.summary.voided == 0);
  REQUIRE(ran.trials.size() == 10);
  for (const auto& trial : ran.trials) {
    CHECK(trial.proof == Proof::ok);
    CHECK(trial.proof_cause == ProofCause::none);
    CHECK(std::abs(trial.drive_ratio_dB.value()) < 0.02);
    CHECK(std::abs(trial.onset_error_us.value()) < 150);
    for (const auto& tone : trial.tones) CHECK(std::abs(tone.measured_dB.value()) < 0.02);
  }
}

TEST_CASE("a stimulus that the surface did not follow is void, named, and presented again",
          "[session][proof]") {
  using plant::FaultKind;
  const auto [kind, cause] = GENERATE(std::pair{FaultKind::transducer_half, ProofCause::half},
                                      std::pair{FaultKind::drive_late, ProofCause::late},
                                      std::pair{FaultKind::frequency_off, ProofCause::frequency});
  const auto ran = run(shipped("demo"), [kind = kind](int trial, plant::Plant& plant) {
    if (trial == 3) plant.add({kind, plant.frames() + 1, plant::kNever, {}, 0});
  });
  INFO(name(cause));
  REQUIRE(ran.trials.size() == 11);
  for (const auto& trial : ran.trials) {
    if (trial.trial_index == 3) {
      CHECK(trial.outcome == terms::Outcome::fault);
      CHECK(trial.proof == (cause == ProofCause::late ? Proof::refused : Proof::stopped));
      CHECK(name(trial.proof_cause) == std::string(name(cause)));
    } else {
      CHECK(trial.outcome == terms::Outcome::answered);
    }
  }
  CHECK(ran.summary.answered == 10);
}

TEST_CASE("a surface that moves before the stimulus makes the trial void, and the cause is named",
          "[session][proof]") {
  const auto [um, verdict] =
      GENERATE(std::pair{0.02, Proof::refused}, std::pair{0.001, Proof::flagged}, std::pair{0.0, Proof::ok});
  CAPTURE(um);
  const auto ran = run(shipped("demo"), [um = um](int trial, plant::Plant& plant) {
    if (trial == 3) plant.add({plant::FaultKind::sounding, plant.frames() + 1, plant::kNever, um, 0});
  });
  REQUIRE(ran.trials.size() == (verdict == Proof::refused ? 11 : 10));
  for (const auto& trial : ran.trials) {
    const bool sounding = trial.trial_index == 3;
    CHECK(trial.proof == (sounding ? verdict : Proof::ok));
    if (sounding && verdict != Proof::ok) CHECK(trial.proof_cause == ProofCause::noisy);
    CHECK(trial.outcome ==
          (trial.proof == Proof::refused ? terms::Outcome::fault : terms::Outcome::answered));
  }
  CHECK(ran.summary.answered == 10);
}

TEST_CASE("a dead surface stops the session with a page that says so", "[session][proof]") {
  const auto ran =
      run(shipped("demo"),
          [](int trial, plant::Plant& plant) {
            if (trial == 2)
              plant.add({plant::FaultKind::transducer_dead, plant.frames() + 1, plant::kNever, {}, 0});
          },
          {kPickUps, false});
  CHECK(ran.summary.status == records::SessionStatus::interrupted);
  REQUIRE(ran.trials.size() == 5);
  CHECK(ran.trials[2].proof == Proof::stopped);
  CHECK(ran.trials[2].proof_cause == ProofCause::dead);
  REQUIRE_FALSE(ran.faults.empty());
  CHECK(ran.faults.front().find("the surface does not move") != std::string::npos);
}

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "station/session/session.hpp"
#include "station/session/simulated_room.hpp"
#include "station/setup/prepare.hpp"
#include "station/store/read.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using terms::Proof;
using terms::ProofCause;

namespace {

const std::string kSource = TURNPOINT_SOURCE_DIR;

std::string with_capture(const TemporaryFolder& folder) {
  std::ostringstream rig;
  rig << std::ifstream(kSource + "/deploy/rigs/simulated.toml").rdbuf()
      << "\n[capture]\nuri = \"sim:\"\nchannels = 4\npickups = [1, 2]\n";
  const auto path = folder / "measured.toml";
  std::ofstream(path) << rig.str();
  return path;
}

/// Adds faults to the room when a trial begins, and repairs them when it ends.
struct Saboteur : session::Monitor {
  std::function<void(int trial)> before, after;
  int trials = 0;
  void trial_begins(const trial::TrialSpec&, const protocol::Block&,
                    const session::PlanAhead::Plans&) override {
    before(trials);
  }
  void trial_ended(const trial::TrialSpec&, const records::TrialRow&) override { after(trials++); }
};

/// Remembers the fault pages of a session.
struct Pages : session::Display {
  std::vector<std::string> faults;
  void show(const session::Page& page) override {
    if (page.kind == session::PageKind::fault) faults.push_back(page.detail);
  }
};

struct Ran {
  session::Summary summary;
  std::vector<records::TrialRow> trials;
  std::vector<std::string> faults;
};

/// What may go wrong in a room before a trial.
using Sabotage = std::function<void(int trial, plant::Plant& plant)>;

/// Runs a protocol in a room with faults. If `repaired`, they last for one trial.
Ran run(const std::string& protocol, const Sabotage& sabotage, bool repaired = true) {
  TemporaryFolder folder;
  setup::RunRequest request;
  request.protocol = kSource + "/protocols/" + protocol + ".toml";
  request.rig = with_capture(folder);
  request.participant = "P01";
  request.database = folder / "a.sqlite";
  request.observer = "sim";
  request.seed = 7;
  const auto setup = setup::prepare(request);
  auto room = std::make_unique<session::SimulatedRoom>(setup.rig);
  Saboteur saboteur;
  auto& plant = room->plant();
  saboteur.before = [&](int trial) { sabotage(trial, plant); };
  saboteur.after = [&](int) {
    if (repaired) plant.repair();
  };
  Pages pages;
  session::Inputs inputs;
  Ran ran;
  ran.summary = session::run(setup, &pages, inputs, std::move(room), &saboteur);
  for (const auto& block : store::read_session(request.database, ran.summary.session_id).blocks)
    ran.trials.insert(ran.trials.end(), block.trials.begin(), block.trials.end());
  ran.faults = pages.faults;
  return ran;
}

}  // namespace

TEST_CASE("without a pick-up a session runs, and each trial is unproven", "[session][proof]") {
  TemporaryFolder folder;
  setup::RunRequest request;
  request.protocol = kSource + "/protocols/demo.toml";
  request.rig = kSource + "/deploy/rigs/simulated.toml";
  request.participant = "P01";
  request.database = folder / "a.sqlite";
  request.observer = "sim";
  session::Inputs inputs;
  const auto summary = session::run(setup::prepare(request), nullptr, inputs);
  for (const auto& block : store::read_session(request.database, summary.session_id).blocks)
    for (const auto& trial : block.trials) {
      CHECK(trial.proof == Proof::unproven);
      CHECK_FALSE(trial.drive_ratio_dB.has_value());
    }
}

TEST_CASE("a pick-up proves each trial of a good session", "[session][proof]") {
  const auto ran = run("demo", [](int, plant::Plant&) {});
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
  const auto ran = run("demo", [kind = kind](int trial, plant::Plant& plant) {
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

TEST_CASE("a dead surface stops the session with a page that says so", "[session][proof]") {
  const auto ran = run(
      "demo",
      [](int trial, plant::Plant& plant) {
        if (trial == 2)
          plant.add({plant::FaultKind::transducer_dead, plant.frames() + 1, plant::kNever, {}, 0});
      },
      false);
  CHECK(ran.summary.status == records::SessionStatus::interrupted);
  REQUIRE(ran.trials.size() == 5);
  CHECK(ran.trials[2].proof == Proof::stopped);
  CHECK(ran.trials[2].proof_cause == ProofCause::dead);
  REQUIRE_FALSE(ran.faults.empty());
  CHECK(ran.faults.front().find("the surface does not move") != std::string::npos);
}

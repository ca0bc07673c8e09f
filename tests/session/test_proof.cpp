#include <algorithm>
#include <cmath>
#include <complex>

#include "station/store/signal_code.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using namespace measured;
using core::Proof;
using core::ProofCause;

namespace {

/// The verdict that the documented limits give for a tone of this level in the silence before a stimulus.
Proof proof_of_silence(double tone_dB) {
  if (tone_dB >= -50) return Proof::refused;
  return tone_dB >= -70 ? Proof::flagged : Proof::ok;
}

/// The amplitude of a planned tone on channel 1 of the captured signal, in its second 100 ms, at the frames
/// at which it was planned.
double amplitude_in(const core::SignalRow& signal, const core::ToneRow& tone) {
  const auto channel = store::decode(signal).at(1);
  constexpr std::int64_t count = 19'200;
  std::complex<double> sum = 0;
  for (auto n = tone.onset_frame + count; n < tone.onset_frame + 2 * count; ++n)
    sum +=
        channel.at(static_cast<std::size_t>(n - signal.start_frame)) *
        std::polar(1.0, -2 * M_PI * std::remainder(tone.frequency_Hz / 192000 * static_cast<double>(n), 1));
  return std::abs(sum) * 2 / count * 0x1p-31;
}

}  // namespace

TEST_CASE("without a pick-up a session runs, and each trial is unproven", "[session][proof]") {
  TemporaryFolder folder;
  auto request = request_in(folder, shipped("demo"));
  request.rig = kSource + "/tests/support/thin_plate.toml";
  session::Inputs inputs;
  const auto summary = session::run(session::prepare(request), nullptr, inputs);
  for (const auto& block : store::read_session(request.database, summary.session_id).blocks)
    for (const auto& trial : block.trials) {
      CHECK(trial.surface.proof == Proof::unproven);
      CHECK_FALSE(trial.surface.drive_ratio_dB.has_value());
    }
}

TEST_CASE("a pick-up proves each trial of a good session", "[session][proof]") {
  const auto ran = run(shipped("demo"), [](int, simulation::Plant&) {});
  CHECK(ran.summary.voided == 0);
  REQUIRE(ran.trials.size() == 10);
  for (const auto& trial : ran.trials) {
    CHECK(trial.surface.proof == Proof::ok);
    CHECK(trial.surface.proof_cause == ProofCause::none);
    CHECK(std::abs(trial.surface.drive_ratio_dB.value()) < 0.02);
    CHECK(std::abs(trial.surface.onset_error_us.value()) < 150);
    CHECK(trial.surface.silence_dB.value() < -45);  // noise of the pick-up, 1e-4 of full scale
    CHECK_FALSE(trial.surface.silence_tone_dB.has_value());
    for (const auto& tone : trial.tones) CHECK(std::abs(tone.measured_dB.value()) < 0.02);
  }
}

TEST_CASE("a stimulus that the surface did not follow is void, named, and presented again",
          "[session][proof]") {
  using simulation::FaultKind;
  const auto [kind, cause] = GENERATE(std::pair{FaultKind::transducer_half, ProofCause::half},
                                      std::pair{FaultKind::drive_late, ProofCause::late},
                                      std::pair{FaultKind::frequency_off, ProofCause::frequency});
  const auto ran = run(shipped("demo"), [kind = kind](int trial, simulation::Plant& plant) {
    if (trial == 3) plant.add({kind, plant.frames() + 1, simulation::kNever, {}, 0});
  });
  INFO(name(cause));
  REQUIRE(ran.trials.size() == 11);
  for (const auto& trial : ran.trials) {
    if (trial.trial_index == 3) {
      CHECK(trial.outcome == core::Outcome::fault);
      CHECK(trial.surface.proof == (cause == ProofCause::late ? Proof::refused : Proof::stopped));
      CHECK(name(trial.surface.proof_cause) == std::string(name(cause)));
    } else {
      CHECK(trial.outcome == core::Outcome::answered);
    }
  }
  CHECK(ran.summary.answered == 10);
}

TEST_CASE("what was captured in a void trial is kept with it, sample by sample", "[session][proof][raw]") {
  const auto with = [](simulation::FaultKind kind) {
    const auto ran = run(shipped("demo"), [kind](int trial, simulation::Plant& plant) {
      if (trial == 3) plant.add({kind, plant.frames() + 1, simulation::kNever, {}, 0});
    });
    REQUIRE(ran.raw.size() == 1);
    CHECK(ran.raw[0].trial_index == 3);
    const auto& signal = ran.raw[0].row;
    const auto& tone = ran.trials.at(3).tones.at(0);
    CHECK(signal.rate_Hz == 192000);
    CHECK(signal.channels.size() == 4);
    CHECK(signal.points <= 4 * 192000);
    const auto stimulus = std::find_if(ran.events.begin(), ran.events.end(), [](const auto& event) {
      return event.kind == "stimulus" && event.trial_index == 3;
    });
    CHECK(signal.start_s == Approx(1e-9 * static_cast<double>(stimulus->time_ns) +
                                   static_cast<double>(signal.start_frame - tone.onset_frame) / 192000)
                                .margin(1e-5));
    return amplitude_in(signal, tone);
  };
  const double whole = with(simulation::FaultKind::drive_late),
               half = with(simulation::FaultKind::transducer_half);
  CHECK(whole > 0.01);
  CHECK(half / whole == Approx(0.5).epsilon(0.001));
}

TEST_CASE("a surface that moves before the stimulus makes the trial void, and the cause is named",
          "[session][proof]") {
  const auto [um, verdict] =
      GENERATE(std::pair{0.02, Proof::refused}, std::pair{0.001, Proof::flagged}, std::pair{0.0, Proof::ok});
  CAPTURE(um);
  const auto ran = run(shipped("demo"), [um = um](int trial, simulation::Plant& plant) {
    if (trial == 3)
      plant.add({simulation::FaultKind::sounding, plant.frames() + 1, simulation::kNever, um, 0});
  });
  REQUIRE(ran.trials.size() == (verdict == Proof::refused ? 11 : 10));
  for (const auto& trial : ran.trials) {
    const bool sounding = trial.trial_index == 3;
    CHECK(trial.surface.proof == (sounding ? verdict : Proof::ok));
    if (sounding && verdict != Proof::ok) CHECK(trial.surface.proof_cause == ProofCause::noisy);
    CHECK(trial.surface.silence_tone_dB.has_value() == (sounding && um > 0));
    if (sounding && um > 0) CHECK(proof_of_silence(trial.surface.silence_tone_dB.value()) == verdict);
    CHECK(trial.outcome ==
          (trial.surface.proof == Proof::refused ? core::Outcome::fault : core::Outcome::answered));
  }
  CHECK(ran.summary.answered == 10);
}

TEST_CASE("a dead surface stops the session with a page that says so", "[session][proof]") {
  const auto ran = run(
      shipped("demo"),
      [](int trial, simulation::Plant& plant) {
        if (trial == 2)
          plant.add({simulation::FaultKind::transducer_dead, plant.frames() + 1, simulation::kNever, {}, 0});
      },
      {kPickUps, false});
  CHECK(ran.summary.status == core::SessionStatus::interrupted);
  REQUIRE(ran.trials.size() == 5);
  CHECK(ran.trials[2].surface.proof == Proof::stopped);
  CHECK(ran.trials[2].surface.proof_cause == ProofCause::dead);
  REQUIRE_FALSE(ran.faults.empty());
  CHECK(ran.faults.front().find("the surface does not move") != std::string::npos);
}

// A response signal that is a buzz of the surface: where it is in the samples, and that it is planned,
// limited, measured and stored like any other scene.
#include <algorithm>
#include <cmath>
#include <set>

#include "station/audio/synth.hpp"
#include "station/core/read_file.hpp"
#include "station/protocol/survey.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/session/stage.hpp"
#include "station/trial/timing.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/replaced.hpp"

using namespace turnpoint;
using namespace measured;

namespace {

constexpr double kLength_s = 0.06;

const char* const kBuzzing =
    "[scene.buzz]\ntones = [{ frequency_Hz = 30000, displacement_um = 0.4 }, { frequency_Hz = 30150, "
    "displacement_um = 0.4 }]\n\n[task]";

std::string source(const std::string& by = "by = \"buzz\", scene = \"buzz\", length_ms = 60",
                   const std::string& buzz = kBuzzing) {
  auto text = replaced(core::read_file(kSource + "/protocols/response-signal.toml"), "window_s = 0.4",
                       "window_s = 0.4, " + by);
  text = replaced(text, "repeats = 84", "repeats = 6");
  return replaced(replaced(text, "trials = 28", "trials = 4"), "[task]", buzz);
}

rig::Rig thin_plate(const std::string& more = "") {
  return rig::parse(core::read_file(kSource + "/tests/support/thin_plate.toml") + more, "rig.toml");
}

std::vector<double> surface_samples(audio::PreparedBurst burst, const audio::Format& format) {
  burst.start_frame = 0;
  burst.marker = {};
  audio::Synth synth(format);
  REQUIRE(synth.start(burst));
  const auto channels = static_cast<std::size_t>(format.channels);
  std::vector<double> block(500 * channels), samples;
  for (std::int64_t frame = 0; frame < burst.length_frames; frame += 500) {
    synth.render(frame, std::span<double>(block));
    for (std::size_t k = 0; k < 500; ++k) samples.push_back(block[k * channels]);
  }
  return samples;
}

std::string problems(const protocol::Survey& survey) {
  std::string all;
  for (const auto* list : {&survey.problems, &survey.warnings})
    for (const auto& problem : *list) all += core::format(problem) + "\n";
  return all;
}

}  // namespace

TEST_CASE("a buzz begins on its very frame and leaves the stimulus before it as it is", "[session][buzz]") {
  const auto rig = thin_plate("\n[marker]\nchannel = 1\nkind = \"code\"\n");
  const auto buzzing = protocol::parse(source(), "p.toml");
  const auto silent = protocol::parse(source("by = \"screen\"", "[task]"), "p.toml");
  const auto stream = session::stream_of(rig);
  const auto format = audio::format_of(stream.output);
  std::set<double> lags;
  for (std::uint64_t seed = 0; seed < 40 && lags.size() < 3; ++seed) {
    trial::Director director(buzzing, 0, seed);
    session::PlanAhead plans(rig, buzzing, seed), without(rig, silent, seed);
    const auto spec = *director.next();
    if (!lags.insert(*spec.signal_s).second) continue;
    INFO("lag of " << *spec.signal_s << " s, foreperiod of " << spec.foreperiod_s << " s");
    const auto burst = plans.take(spec).bursts.back();
    const auto at = std::llround((spec.foreperiod_s + *spec.signal_s) * format.rate_Hz);
    REQUIRE(burst.change_count == 3);
    CHECK(burst.changes[0].at_frame == std::llround(spec.foreperiod_s * format.rate_Hz));
    CHECK(burst.changes[1].at_frame == at);
    CHECK(std::abs(burst.changes[2].at_frame - at - std::llround(kLength_s * format.rate_Hz)) <= 1);
    // the change has a trigger code, the buzz has none
    CHECK(burst.marker.patterns[1] != 0);
    CHECK(burst.marker.patterns[2] == 0);
    CHECK(burst.marker.patterns[3] == 0);
    const auto with = surface_samples(burst, format);
    const auto plain = surface_samples(without.take(spec).bursts.back(), format);
    REQUIRE(with.size() == plain.size());
    std::size_t first = 0;
    while (first < with.size() && std::abs(with[first] - plain[first]) < 1e-9) ++first;
    CHECK(static_cast<std::int64_t>(first) >= at);
    CHECK(static_cast<std::int64_t>(first) <= at + 4);  // the ramp of 5 ms begins with a slope of 0
    double before = 0, during = 0;
    for (std::int64_t k = at + 1920; k < at + 9600; ++k)
      during = std::max(during, std::abs(with[static_cast<std::size_t>(k)]));
    for (std::int64_t k = at - 9600; k < at; ++k)
      before = std::max(before, std::abs(with[static_cast<std::size_t>(k)]));
    CHECK(during > 0.02);
    CHECK(std::abs(during - before) > 0.001);
  }
  CHECK(lags.size() == 3);
}

TEST_CASE("a buzz is measured by the pick-ups and stored with its frames, like any scene",
          "[session][buzz][proof]") {
  const TemporaryFolder folder;
  const auto path = folder / "buzz.toml";
  const bool broken = GENERATE(false, true);
  std::ofstream(path) << source();
  int faulted = 0;
  const auto ran = run(path, [&](int trial, simulation::Plant& plant) {
    if (broken && trial == 6)
      plant.add({simulation::FaultKind::transducer_half, plant.frames() + 1, simulation::kNever, {}, 0}),
          ++faulted;
  });
  CHECK(faulted == (broken ? 1 : 0));
  int buzzes = 0;
  for (const auto& trial : ran.trials) {
    CAPTURE(trial.trial_index, name(trial.surface.proof), name(trial.surface.proof_cause),
            trial.surface.drive_ratio_dB.value_or(99), name(trial.outcome));
    if (broken && trial.trial_index == 6) {
      CHECK(trial.outcome == core::Outcome::fault);
      continue;
    }
    CHECK(trial.surface.proof == core::Proof::ok);
    const auto lag_s = std::get<double>(trial.factors.at("lag_s"));
    std::int64_t change = 0;
    for (const auto& tone : trial.tones)
      if (tone.scene == "after" && tone.scene_index == 1) change = tone.onset_frame;
    for (const auto& tone : trial.tones) {
      if (tone.scene != "buzz") continue;
      ++buzzes;
      CHECK(tone.scene_index == 2);
      CHECK(std::abs(static_cast<double>(tone.onset_frame - change) - 192000 * lag_s) <= 1);
      CHECK(std::abs(static_cast<double>(tone.length_frames) - 192000 * kLength_s) <= 1);
      REQUIRE(tone.measured_dB);
      CHECK(std::abs(*tone.measured_dB) < 0.2);
    }
    CHECK(trial.tones.back().scene == "after");  // the last scene comes back
    CHECK(trial.tones.back().scene_index == 3);
  }
  CHECK(buzzes >= 40);
}

TEST_CASE("a buzz that fails alone makes its trial void", "[session][buzz][proof]") {
  const TemporaryFolder folder;
  const auto path = folder / "buzz.toml";
  // with a fixed foreperiod and lag, the buzz begins 1.6 s after the onset in each trial
  auto text = replaced(source(), "{ uniform = [1.0, 2.5] }", "1.0");
  text = replaced(text, "levels = [0.1, 0.2, 0.35, 0.6, 1.0, 1.6]", "levels = [0.6]");
  std::ofstream(path) << text;
  constexpr std::int64_t kToBuzz = 24'960 + 1'600 * 192;  // see test_glides.cpp
  const auto ran = run(path, [&](int trial, simulation::Plant& plant) {
    if (trial == 1)
      plant.add({simulation::FaultKind::transducer_half,
                 plant.frames() + kToBuzz + 1'500,
                 plant.frames() + kToBuzz + 9'000,
                 {},
                 0});
  });
  for (const auto& trial : ran.trials) {
    CAPTURE(trial.trial_index, name(trial.surface.proof), name(trial.surface.proof_cause),
            trial.surface.drive_ratio_dB.value_or(99));
    CHECK((trial.outcome == core::Outcome::fault) == (trial.trial_index == 1));
    CHECK((trial.surface.proof == core::Proof::ok) == (trial.trial_index != 1));
  }
}

TEST_CASE("the limits of the rig hold for a buzz as for each scene", "[session][buzz]") {
  const auto rig = thin_plate();
  const auto good = protocol::parse(source(), "p.toml");
  CHECK(problems(protocol::survey(good, rig)).find("buzz") == std::string::npos);
  const auto strong = protocol::parse(
      source("by = \"buzz\", scene = \"buzz\", length_ms = 60",
             "[scene.buzz]\ntones = [{ frequency_Hz = 30000, displacement_um = 40 }]\n\n[task]"),
      "p.toml");
  CHECK(problems(protocol::survey(strong, rig)).find("scene \"buzz\"") != std::string::npos);
}

TEST_CASE("a buzz that could tell the answer is refused", "[session][buzz][cues]") {
  // The factor decides the answer, and the buzz depends on it: directly, or by the scene on which it is
  // based.
  for (const std::string buzz :
       {"base = \"after\"\nrove_dB = 1", "base = \"after\"\nzone = { friction = 0.3 }",
        "tones = [{ frequency_Hz = \"30000 + 1000 * change\", displacement_um = 0.4 }]"}) {
    CAPTURE(buzz);
    try {
      protocol::parse(
          source("by = \"buzz\", scene = \"buzz\", length_ms = 60", "[scene.buzz]\n" + buzz + "\n\n[task]"),
          "p.toml");
      FAIL_CHECK("the protocol is accepted");
    } catch (const core::BadInput& error) {
      REQUIRE(error.problems().size() == 1);
      CHECK(core::format(error.problems().front()).find("the buzz depends on \"change\"") !=
            std::string::npos);
    }
  }
}

TEST_CASE("a buzz has the same strength in each trial, even if the stimulus is roved",
          "[session][buzz][cues]") {
  const auto rig = thin_plate();
  const auto roving =
      protocol::parse(replaced(source(), "[scene.before]", "[scene.before]\nrove_dB = 3"), "p.toml");
  std::set<double> buzzes, stimuli;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    trial::Director director(roving, 0, seed);
    session::PlanAhead plans(rig, roving, seed);
    const auto& plan = plans.take(*director.next()).plans.back();
    REQUIRE(plan.size() == 4);
    REQUIRE(plan[2].scene.name == "buzz");
    buzzes.insert(plan[2].peak_displacement_m);
    stimuli.insert(plan[0].peak_displacement_m);
    // the last scene returns as it was
    CHECK(plan[3].peak_displacement_m == plan[1].peak_displacement_m);
  }
  CHECK(buzzes.size() == 1);
  CHECK(stimuli.size() == 4);
}

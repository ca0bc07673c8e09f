// Tests the cue guard's report on protocols in which a cue is known to reveal the answer.
#include "station/rehearsal/cue_guard.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "station/core/read_file.hpp"
#include "station/core/toml.hpp"
#include "station/protocol/resolve.hpp"
#include "station/rehearsal/cue_table.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/scene/planner.hpp"
#include "tests/rehearsal/random_protocol.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"

using namespace turnpoint;

namespace {

const std::string root = TURNPOINT_SOURCE_DIR;

std::string source(const std::string& name) { return core::read_file(root + "/protocols/" + name); }

rehearsal::CueGuard guard_of(const std::string& text) {
  const auto protocol = protocol::parse(text, "p.toml");
  return rehearsal::cue_guard(protocol, quick_rig(), protocol::survey(protocol, quick_rig()));
}

const rehearsal::CueReport& report(const rehearsal::CueGuard& guard, std::string_view cue) {
  for (const auto& report : guard.reports)
    if (report.cue == cue) return report;
  FAIL("no report of " << cue << " " << guard.not_compared << guard.nothing_to_tell);
  throw std::logic_error("not reached");
}

double accuracy(const std::string& text, const std::string& cue) {
  return report(guard_of(text), cue).accuracy;
}

/// A protocol with a pair of scenes. The standard depends on one factor; the target depends on that factor
/// and on the level.
const std::string pair_text = R"(format = "friction-protocol/1"
[protocol]
id = "pair"
version = "1"
title = "Pair"
languages = ["en"]
[[factor]]
name = "level_mm"
range = [-20.0, 20.0]
[[factor]]
name = "mark_mm"
levels = [150.0, 158.0]
[scene.standard]
boundary_mm = "mark_mm"
edge = "p50"
displacement_um = 1.0
[scene.target]
boundary_mm = "mark_mm + level_mm"
edge = "p50"
displacement_um = 1.0
[task]
kind = "2ifc"
intervals = ["standard", "target"]
correct = "target"
duration_s = 1.0
gap_s = 0.5
device = "touch"
question = { en = "Which?" }
choices = [{ id = "a", label = { en = "A" } }, { id = "b", label = { en = "B" } }]
[timing]
response_zero = "interval_off"
deadline_s = 6.0
iti_s = 0.5
[[procedure]]
name = "p"
kind = "constant-stimuli"
level = "level_mm"
values = [4.0, 8.0, 16.0]
repeats = 8
[[block]]
name = "main"
procedures = ["p"]
)";

}  // namespace

TEST_CASE(
    "if the standard depends on a factor, and the target on the factor and the level, they are compared in "
    "each trial",
    "[cues]") {
  const auto guard = guard_of(pair_text);
  CHECK(report(guard, "strip width").accuracy == Approx(1));
  CHECK(report(guard, "duration").accuracy == Approx(0.5));
  CHECK(report(guard, "always the same key").accuracy == Approx(0.5));
}

TEST_CASE("the trials of a 2ifc count although the right interval depends on the level", "[cues]") {
  const auto by_level = [](const std::string& levels) {
    const auto text = replaced(pair_text, "correct = \"target\"",
                               "correct = { target = \"level_mm > 0\", standard = \"level_mm <= 0\" }");
    return guard_of(replaced(text, "values = [4.0, 8.0, 16.0]", "values = " + levels));
  };
  // The wider interval is right at every level, and it is wider than the other one.
  CHECK(report(by_level("[-8.0, 8.0]"), "strip width").accuracy == Approx(1));
  CHECK(report(by_level("[-8.0, 8.0]"), "duration").accuracy == Approx(0.5));
}

TEST_CASE("an observer who knows the standard recognises a target that differs from it in either direction",
          "[cues]") {
  const auto both = replaced(pair_text, "values = [4.0, 8.0, 16.0]", "values = [-8.0, 8.0]");
  const auto fixed = replaced(both, "levels = [150.0, 158.0]", "levels = [155.0]");
  CHECK(accuracy(fixed, "strip width") == Approx(1));
}

TEST_CASE("a target with ramps of its own is recognised by its duration", "[cues]") {
  const auto text = source("friction-2ifc.toml");
  const std::string contrast = "friction_contrast_dB = \"contrast_dB\"";
  CHECK(accuracy(replaced(text, contrast, contrast + "\nramp_ms = 300"), "duration") == Approx(1));
  CHECK(accuracy(text, "duration") == Approx(0.5));
}

TEST_CASE(
    "with three intervals, a leak always reveals the odd one, and guessing is right in a third of trials",
    "[cues]") {
  const auto guard = guard_of(source("two-spots-oddity.toml"));
  CHECK(report(guard, "strip width").accuracy == Approx(1));
  CHECK(report(guard, "duration").accuracy == Approx(1.0 / 3));
  CHECK(report(guard, "duration").chance == Approx(1.0 / 3));
}

TEST_CASE("with a fixed mark, the strip's width reveals the side; with a moving mark it reveals less",
          "[cues]") {
  const auto text = source("boundary-constant.toml");
  const auto fixed = guard_of(replaced(text, "levels = [152.0, 158.0, 164.0]", "levels = [158.0]"));
  const auto moving = guard_of(text);
  CHECK(report(fixed, "strip width").accuracy == Approx(1));
  CHECK(report(moving, "strip width").accuracy < 0.95);
  CHECK(report(moving, "always the same key").accuracy == Approx(0.5));
}

TEST_CASE("if the answer depends on the distance from the mark, a band of the cue's values reveals it",
          "[cues]") {
  auto text =
      replaced(source("boundary-constant.toml"), "levels = [152.0, 158.0, 164.0]", "levels = [158.0]");
  text = replaced(text, "correct = { left = \"offset_mm < 0\", right = \"offset_mm > 0\" }",
                  "correct = { left = \"abs(offset_mm) < 10\", right = \"abs(offset_mm) > 10\" }");
  CHECK(accuracy(text, "strip width") == Approx(1));
}

TEST_CASE("the levels of practice do not count, and they do not remove levels from the main blocks",
          "[cues]") {
  const auto with = guard_of(source("boundary-constant.toml"));
  auto text = source("boundary-constant.toml");
  text = replaced(text, "levels = [-28.0, 28.0]\ntrials", "levels = [3.0, 8.0, 16.0, 28.0]\ntrials");
  const auto other = guard_of(text);
  for (const auto& one : with.reports) {
    INFO(one.cue);
    CHECK(report(other, one.cue).accuracy == Approx(one.accuracy).epsilon(0).margin(1e-12));
  }
  // Practice blocks are left out, but the main block is not, although it runs the same procedure.
  CHECK(accuracy(source("speed-accuracy.toml"), "amplitude at the wide end") > 0.9);
}

TEST_CASE("all trials, including catch trials, are weighted by how often they occur", "[cues]") {
  const auto text =
      replaced(source("boundary-constant.toml"), "values = [-28.0, -16.0, -8.0, -3.0, 3.0, 8.0, 16.0, 28.0]",
               "values = [-3.0, 3.0, 8.0, 16.0]");
  CHECK(accuracy(text, "always the same key") == Approx(0.75));
  // In all catch trials "left" is the right answer.
  const std::string block = "procedures = [\"levels\"]";
  const auto caught = replaced(text, block, block + "\ncatch = { rate = 0.5, offset_mm = -28.0 }");
  // Half of all trials are catch trials, so "right" is correct in 0.5 x 0.75 = 37.5 % of all trials, and
  // "left" in 62.5 %.
  CHECK(accuracy(caught, "always the same key") == Approx(0.625));
  // Without catch trials, "right" is correct in 75 % of the trials. This stays so if the block ends after 12
  // trials, because these are a random choice from the 40 planned ones.
  const auto cut = replaced(text, block, block + "\ntrials = 12");
  CHECK(accuracy(cut, "always the same key") == Approx(0.75));
}

TEST_CASE("if a list of levels is cut short and not shuffled, only its first levels count", "[cues]") {
  const auto text = replaced(pair_text, "values = [4.0, 8.0, 16.0]",
                             "order = { shuffle = \"none\" }\nvalues = [4.0, 8.0, 0.0]");
  const auto cut = replaced(text, "procedures = [\"p\"]", "procedures = [\"p\"]\ntrials = 2");
  CHECK(accuracy(text, "strip width") == Approx(5.0 / 6));
  CHECK(accuracy(cut, "strip width") == Approx(1));
}

namespace {

/// A staircase with roving (random changes of the amplitude), which changes the amplitude more than most
/// levels do.
std::string roved_staircase(int trials) {
  auto text = replaced(pair_text, "kind = \"constant-stimuli\"", "kind = \"up-down\"");
  text = replaced(text, "values = [4.0, 8.0, 16.0]\nrepeats = 8",
                  "start = 12.0\nmin = 0.5\nmax = 20.0\nn_down = 2\nstep = [4.0, 2.0]\nstop = { trials = " +
                      std::to_string(trials) + " }");
  const std::string target = "boundary_mm = \"mark_mm + level_mm\"\nedge = \"p50\"\ndisplacement_um = 1.0";
  text = replaced(text, target,
                  "boundary_mm = \"mark_mm\"\nedge = \"p50\"\ndisplacement_um = \"1 + 0.03 * level_mm\"\n"
                  "rove_dB = 3.0");
  return replaced(text, "boundary_mm = \"mark_mm\"\nedge = \"p50\"\ndisplacement_um = 1.0",
                  "boundary_mm = \"mark_mm\"\nedge = \"p50\"\ndisplacement_um = 1.0\nrove_dB = 3.0");
}

}  // namespace

TEST_CASE(
    "a cue that helps only at the easiest levels is found in sessions in which its own answers choose the "
    "levels",
    "[cues]") {
  const auto guard = guard_of(roved_staircase(60));
  const auto& amplitude = report(guard, "amplitude at the wide end");
  REQUIRE(amplitude.whole_sessions);
  // The staircase converges on the level with 71 % right answers.
  CHECK(amplitude.whole_sessions->accuracy == Approx(0.72).margin(0.03));
  CHECK(amplitude.accuracy >= amplitude.whole_sessions->accuracy);
  // Duration is the same at every level, so the guard need not simulate sessions for it.
  CHECK(report(guard, "duration").accuracy == Approx(0.5));
  CHECK(report(guard, "duration").whole_sessions->error == 0);
}

TEST_CASE(
    "easy practice does not raise a cue's accuracy in sessions in which its own answers choose the levels",
    "[cues]") {
  const auto main = std::string("[[block]]\nname = \"main\"");
  const auto practised = replaced(roved_staircase(60), main,
                                  "[[block]]\nname = \"practice\"\nlevel = \"level_mm\"\nlevels = [20.0]\n"
                                  "trials = 60\npractice = true\n" +
                                      main);
  const auto reached = [](const std::string& text) {
    const auto guard = guard_of(text);
    const auto& own = report(guard, "amplitude at the wide end").whole_sessions;
    REQUIRE(own);
    return own->accuracy;
  };
  // Sixty practice trials, in which the cue is always right, would raise 0.72 to 0.86 if they were counted.
  CHECK(reached(practised) == Approx(reached(roved_staircase(60))).margin(0.03));
}

TEST_CASE("the accuracy of a rule is measured on other random draws than those that chose the rule",
          "[cues]") {
  // With roving, the amplitude says nothing about the right answer. The best of many rules only fits the
  // random draws from which it was chosen, so it must be no better than chance for other draws.
  std::map<std::string, int> features;
  const auto guard = guard_of(tests::random_protocol(20076, features));
  const auto& amplitude = report(guard, "amplitude at the wide end");
  CHECK(amplitude.accuracy - amplitude.chance < 0.01);
}

TEST_CASE("two cues share simulated sessions only if they give the same answers at every level that occurred",
          "[cues]") {
  // The amplitude cannot distinguish 154.6 mm from 158 mm, but the strip's width can.
  std::map<std::string, int> features;
  const auto guard = guard_of(replaced(tests::random_protocol(31103, features), "\"155\"", "\"154.6\""));
  REQUIRE(report(guard, "strip width").whole_sessions);
  CHECK(report(guard, "amplitude at the wide end").whole_sessions->accuracy < 0.98);
  CHECK(report(guard, "strip width").whole_sessions->accuracy > 0.995);
}

TEST_CASE("if the count of sessions had to end early, its precision is stated", "[cues]") {
  const auto error_of = [](const std::string& text) {
    const auto guard = guard_of(text);
    const auto& own = report(guard, "amplitude at the wide end").whole_sessions;
    REQUIRE(own);
    return own->error;
  };
  CHECK(error_of(roved_staircase(60)) == Approx(0.01).epsilon(0.2));
  CHECK(error_of(replaced(roved_staircase(8), "step = [4.0, 2.0]", "step = [8.0]")) > 0.012);
}

namespace {

/// The proportion correct of an observer who presses this key in each trial of simulated sessions.
double pressed(const std::string& text, int key) {
  const auto protocol = protocol::parse(text, "p.toml");
  double trials = 0, right = 0;
  const auto press = [&](const trial::TrialSpec&, const simulation::Question&) {
    simulation::Reply reply;
    reply.choice = key;
    return reply;
  };
  for (std::uint64_t seed = 0; seed < 5; ++seed)
    for (const auto& block : rehearsal::rehearse(protocol, {}, seed, {press, {}}).blocks)
      for (const auto& trial : block.trials)
        if (trial.type == core::TrialType::experimental && trial.given.correct)
          trials += 1, right += *trial.given.correct ? 1 : 0;
  return right / trials;
}

}  // namespace

TEST_CASE("always pressing the same key is judged in the sessions to which this key leads", "[cues]") {
  const auto text = source("friction-yes-no.toml");
  const auto guard = guard_of(text);
  const auto& key = report(guard, "always the same key");
  CHECK(key.accuracy == Approx(std::max({0.5, pressed(text, 0), pressed(text, 1)})).margin(0.01));
  // "Yes" is right at 11 of the 12 levels, but QUEST+ does not present all levels equally often.
  CHECK(std::fabs(key.accuracy - 11.0 / 12) > 0.02);
  CHECK(key.whole_sessions);
}

TEST_CASE("a cue that gives every answer away is found although the answer is the same at nearly all levels",
          "[cues]") {
  const auto guard = guard_of(source("friction-yes-no.toml"));
  const auto& amplitude = report(guard, "amplitude at the wide end");
  CHECK(amplitude.accuracy == Approx(1));
  CHECK(amplitude.above_chance());
}

TEST_CASE("with a procedure that tracks a side, only a constant key is judged in sessions of its own",
          "[cues]") {
  const auto guard = guard_of(source("boundary-adaptive.toml"));
  const auto& key = report(guard, "always the same key");
  CHECK(key.whole_sessions);
  CHECK(key.accuracy == Approx(0.5));
  for (const auto& one : guard.reports) CHECK((one.cue == key.cue || !one.whole_sessions));
  CHECK(report(guard, "strip width").accuracy > 0.9);
}

TEST_CASE("if trials cannot be compared, the guard says which and states no accuracy", "[cues]") {
  const auto protocol = protocol::parse(source("friction-2ifc.toml"), "p.toml");
  auto survey = protocol::survey(protocol, quick_rig());
  CHECK(rehearsal::cue_guard(protocol, quick_rig(), survey).not_compared.empty());
  const auto missing = [](const protocol::Sight& sight) {
    return sight.scene == "comparison" && std::get<double>(sight.factors.at("contrast_dB")) < -20;
  };
  survey.sights.erase(std::remove_if(survey.sights.begin(), survey.sights.end(), missing),
                      survey.sights.end());
  const auto guard = rehearsal::cue_guard(protocol, quick_rig(), survey);
  CHECK(guard.reports.empty());
  CHECK(guard.not_compared.find("scene \"comparison\" at contrast_dB = ") == 0);
}

TEST_CASE("for a task without right answers, the guard says that a cue can reveal nothing", "[cues]") {
  const auto guard = guard_of(source("boundary-adjustment.toml"));
  CHECK(guard.reports.empty());
  CHECK(guard.not_compared.empty());
  CHECK_FALSE(guard.nothing_to_tell.empty());
}

// Trials whose intervals consist of several scenes with silences between them, and trials whose lengths and
// pauses depend on factors: when each part is in the samples, and that it is checked, limited, measured,
// stored, and presented again like any other stimulus.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "station/audio/synth.hpp"
#include "station/core/read_file.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/design_advice.hpp"
#include "station/protocol/survey.hpp"
#include "station/rehearsal/check.hpp"
#include "station/rehearsal/cue_guard.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/session/exposure.hpp"
#include "station/session/finger_account.hpp"
#include "station/session/pages.hpp"
#include "station/session/plan_ahead.hpp"
#include "station/session/resume.hpp"
#include "station/session/stage.hpp"
#include "station/trial/timing.hpp"
#include "tests/session/live_room.hpp"
#include "tests/session/measured_session.hpp"
#include "tests/session/screen.hpp"
#include "tests/session/stored_trials.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/replaced.hpp"

using namespace turnpoint;
using namespace measured;

namespace {

constexpr int kRate_Hz = 192000;

const char* const kHead = R"(format = "friction-protocol/1"
[protocol]
id = "parts"
version = "1"
title = "Parts"
languages = ["en"]
[[factor]]
name = "offset_mm"
range = [-20.0, 20.0]
[[factor]]
name = "isi_s"
levels = [0.25, 0.5, 1.0]
[[factor]]
name = "lead_s"
range = [0.5, 0.7]
draw = "uniform"
[scene.adaptor]
boundary_mm = 150.0
edge = "p50"
displacement_um = 1.0
[scene.test]
base = "adaptor"
boundary_mm = "150 + offset_mm"
)";

const char* const kTail = R"(
[[procedure]]
name = "levels"
kind = "constant-stimuli"
level = "offset_mm"
values = [-8.0, 8.0]
repeats = 4
[[block]]
name = "first"
procedures = ["levels"]
break_after = { trials = 3, min_s = 1 }
[[block]]
name = "second"
procedures = ["levels"]
)";

/// Answers after an adaptor, which is longer in the first trial, and a silence that is a factor.
const std::string kAdaptation = std::string(kHead) + R"([task]
kind = "single-interval"
intervals = ["adapted"]
device = "touch"
question = { en = "Left or right?" }
choices = [{ id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } }]
correct = { left = "offset_mm < 0", right = "offset_mm > 0" }
[task.parts]
adapted = [
  { scene = "adaptor", duration_s = "lead_s", first_s = 2.0 },
  { silence_s = 0.1 },
  { silence_s = "isi_s" },
  { scene = "test", duration_s = 0.4 },
]
[timing]
response_zero = "interval_off"
deadline_s = 20.0
iti_s = 1.0
)" + kTail;

/// Two intervals with a length and a pause that are factors.
const std::string kPauses = std::string(kHead) + R"([task]
kind = "2ifc"
intervals = ["adaptor", "test"]
duration_s = "lead_s"
gap_s = "2 * isi_s"
device = "touch"
question = { en = "Which?" }
choices = [{ id = "first", label = { en = "First" } }, { id = "second", label = { en = "Second" } }]
correct = { test = "offset_mm > 0", adaptor = "offset_mm < 0" }
[timing]
response_zero = "interval_off"
deadline_s = 20.0
iti_s = 1.0
)" + kTail;

/// The standard, a silence, and a scene that the slider changes.
const std::string kMatching = std::string(kHead) + R"([task]
kind = "adjustment"
intervals = ["pair"]
adjusts = "offset_mm"
step = 0.5
device = "touch"
question = { en = "Make the second one like the first." }
choices = [{ id = "done", label = { en = "Done" } }]
[task.parts]
pair = [{ scene = "adaptor", duration_s = 0.6 }, { silence_s = "isi_s" }, { scene = "test" }]
[timing]
response_zero = "go_cue"
explore_s = 25.0
deadline_s = 40.0
iti_s = 1.0
[[procedure]]
name = "settings"
kind = "adjustment"
level = "offset_mm"
start_below = [-10.0]
start_above = [10.0]
repeats = 3
[[block]]
name = "main"
procedures = ["settings"]
)";

rig::Rig thin_plate() {
  return rig::parse(core::read_file(kSource + "/tests/support/thin_plate.toml"), "rig.toml");
}

double number(const protocol::Factors& factors, const std::string& name) {
  return std::get<double>(factors.at(name));
}

double number(const core::TrialRow& row, const std::string& name) {
  return std::get<double>(row.factors.at(name));
}

/// The stretches of frames in which the surface moves, from the rendered samples of a whole trial. Zero
/// crossings are shorter than the longest silence inside of a tone.
std::vector<std::pair<std::int64_t, std::int64_t>> moving(const std::vector<audio::PreparedBurst>& bursts,
                                                          const audio::Format& format) {
  const auto channels = static_cast<std::size_t>(format.channels);
  const auto end = bursts.back().start_frame + bursts.back().length_frames + 4800;
  std::vector<double> samples(static_cast<std::size_t>(end));
  for (auto burst : bursts) {
    audio::Synth synth(format);
    burst.marker = {};
    REQUIRE(synth.start(burst));
    std::vector<double> block(480 * channels);
    for (std::int64_t frame = 0; frame + 480 <= end; frame += 480) {
      synth.render(frame, std::span<double>(block));
      for (std::size_t k = 0; k < 480; ++k)
        samples[static_cast<std::size_t>(frame) + k] += block[k * channels];
    }
  }
  std::vector<std::pair<std::int64_t, std::int64_t>> found;
  constexpr std::int64_t longest_crossing = 200;
  for (std::int64_t k = 0; k < end; ++k) {
    if (std::abs(samples[static_cast<std::size_t>(k)]) < 1e-7) continue;
    if (found.empty() || k - found.back().second > longest_crossing) found.emplace_back(k, k);
    found.back().second = k;
  }
  return found;
}

/// First frame and length of each part, as stored.
std::map<int, std::pair<std::int64_t, std::int64_t>> stored_parts(const core::TrialRow& row) {
  std::map<int, std::pair<std::int64_t, std::int64_t>> parts;
  for (const auto& tone : row.tones)
    parts.try_emplace(tone.interval_index, tone.onset_frame, tone.length_frames);
  return parts;
}

std::int64_t frames(double s) { return std::llround(s * kRate_Hz); }

std::vector<core::TrialRow> session_of(const std::string& text) {
  const TemporaryFolder folder;
  const auto request = simulated_run(written(folder, text), folder / "a.sqlite", 5);
  session::Inputs nobody;
  const auto summary = session::run(session::prepare(request), nullptr, nobody);
  REQUIRE(summary.status == core::SessionStatus::completed);
  return trials_of(request.database, summary.session_id);
}

std::string said(const std::vector<core::Problem>& problems) {
  std::string all;
  for (const auto& problem : problems) all += core::format(problem) + "\n";
  return all;
}

double accuracy(const std::string& text, const std::string& cue, const rig::Rig& rig = thin_plate()) {
  const auto protocol = protocol::parse(text, "p.toml");
  const auto guard = rehearsal::cue_guard(protocol, rig, protocol::survey(protocol, rig));
  for (const auto& report : guard.reports)
    if (report.cue == cue) return report.accuracy;
  FAIL("no report of " << cue);
  return 0;
}

}  // namespace

TEST_CASE("each part begins and ends in the samples where the file puts it", "[session][parts]") {
  const auto rig = thin_plate();
  const auto format = audio::format_of(session::stream_of(rig).output);
  const auto protocol = protocol::parse(kAdaptation, "p.toml");
  trial::Director director(protocol, 0, 3);
  session::PlanAhead plans(rig, protocol, 3);
  for (int k = 0; k < 4; ++k) {
    const auto spec = *director.next();
    const double first_s = k == 0 ? 2.0 : number(spec.factors, "lead_s");
    const double silent_s = 0.1 + number(spec.factors, "isi_s");
    const auto found = moving(plans.take(spec).bursts, format);
    INFO("trial " << k << ": " << first_s << " s, silence of " << silent_s << " s");
    REQUIRE(found.size() == 2);
    // a ramp begins and ends with a slope of 0, so the first and the last frames are too small to be seen
    constexpr std::int64_t ramp = 60;
    const std::int64_t edges[] = {0, frames(first_s), frames(first_s) + frames(silent_s),
                                  frames(first_s) + frames(silent_s) + frames(0.4)};
    CHECK(found[0].first >= edges[0]);
    CHECK(found[0].first <= edges[0] + ramp);
    CHECK(found[0].second < edges[1]);
    CHECK(found[0].second >= edges[1] - ramp);
    CHECK(found[1].first >= edges[2]);
    CHECK(found[1].first <= edges[2] + ramp);
    CHECK(found[1].second < edges[3]);
    CHECK(found[1].second >= edges[3] - ramp);
    director.record({core::Outcome::answered, 0, true, {}, {}});
  }
}

TEST_CASE("a pause and a length that are factors last as long as the trial's factors say, to the frame",
          "[session][parts]") {
  const auto trials = session_of(kPauses);
  CHECK(trials.size() == 16);
  std::map<double, int> pauses;
  for (const auto& trial : trials) {
    const auto parts = stored_parts(trial);
    REQUIRE(parts.size() == 2);
    const double length_s = number(trial, "lead_s"), gap_s = 2 * number(trial, "isi_s");
    CHECK(parts.at(0).second == frames(length_s));
    CHECK(parts.at(1).second == frames(length_s));
    CHECK(parts.at(1).first - parts.at(0).first == frames(length_s) + frames(gap_s));
    CHECK(trial.timing.response_time_s.value_or(0) > 0);  // counted from the end
    ++pauses[gap_s];
  }
  CHECK(pauses.size() == 3);
}

TEST_CASE("the first trial of a block, and that after a break, have the long adaptor; others its top-up",
          "[session][parts]") {
  const auto trials = session_of(kAdaptation);
  REQUIRE(trials.size() == 16);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    INFO("trial " << i);
    const auto parts = stored_parts(trials[i]);
    REQUIRE(parts.size() == 2);
    // breaks come after every third trial of the first block, which has eight
    const bool is_long = i == 0 || i == 3 || i == 6 || i == 8;
    CHECK(parts.at(0).second == frames(is_long ? 2.0 : number(trials[i], "lead_s")));
    CHECK(parts.at(1).first - parts.at(0).first - parts.at(0).second ==
          frames(0.1 + number(trials[i], "isi_s")));
    CHECK(parts.at(1).second == frames(0.4));
  }
}

TEST_CASE("a session of parts that is cut at any page goes on with the same trials", "[session][parts]") {
  const TemporaryFolder folder;
  const auto file = written(folder, kAdaptation);
  const auto request = [&](const std::string& database) { return simulated_run(file, folder / database, 5); };
  session::Inputs inputs;
  const auto whole = session::run(session::prepare(request("whole.sqlite")), nullptr, inputs);
  const auto expected = trials_of(folder / "whole.sqlite", whole.session_id);
  for (int page = 9; page < 30; page += 4) {
    INFO("cut at page " << page);
    const auto database = folder / ("cut" + std::to_string(page) + ".sqlite");
    Screen cut(page);
    const auto setup = session::prepare(request("cut" + std::to_string(page) + ".sqlite"));
    CHECK_THROWS_AS(session::run(setup, &cut, inputs), std::runtime_error);
    std::ostringstream messages;
    const auto resumed = session::prepare_resume({database, "", "resume", true}, messages);
    REQUIRE(resumed.has_value());
    const auto done = trials_of(database, resumed->resume_session).size();
    const auto summary = session::run(*resumed, nullptr, inputs);
    CHECK(summary.status == core::SessionStatus::completed);
    const auto trials = trials_of(database, summary.session_id);
    REQUIRE(trials.size() == expected.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      CHECK(trials[i].factors == expected[i].factors);
      CHECK(trials[i].given.response == expected[i].given.response);
      CHECK(trials[i].learned.state_hash == expected[i].learned.state_hash);
    }
    // adaptation has worn off while the session was interrupted
    if (done < trials.size()) CHECK(stored_parts(trials[done]).at(0).second == frames(2.0));
  }
}

TEST_CASE(
    "pick-ups measure every part; a part that is weaker than planned makes the trial void, and it is "
    "presented again as it was",
    "[session][parts][proof]") {
  const TemporaryFolder folder;
  const auto path = written(folder, kAdaptation);
  const bool broken = GENERATE(false, true);
  const auto ran = run(path, [&](int trial, simulation::Plant& plant) {
    if (broken && trial == 4)
      plant.add({simulation::FaultKind::transducer_half, plant.frames() + 1, simulation::kNever, {}, 0});
  });
  CHECK(ran.trials.size() == (broken ? 17 : 16));
  for (const auto& trial : ran.trials) {
    INFO("trial " << trial.trial_index);
    if (broken && trial.trial_index == 4) {
      CHECK(trial.outcome == core::Outcome::fault);
      continue;
    }
    CHECK(trial.surface.proof == core::Proof::ok);
    std::map<int, int> seen;
    for (const auto& tone : trial.tones) {
      REQUIRE(tone.measured_dB);
      CHECK(std::abs(*tone.measured_dB) < 0.2);
      ++seen[tone.interval_index];
    }
    CHECK(seen.size() == 2);
  }
  if (!broken) return;
  CHECK(ran.trials[4].factors == ran.trials[5].factors);
  CHECK(ran.trials[4].trial_in_block == ran.trials[5].trial_in_block);
}

TEST_CASE("the slider moves only the last part, and its page comes with it", "[session][parts]") {
  const TemporaryFolder folder;
  auto request = simulated_run(written(folder, kMatching), folder / "a.sqlite", 5);
  request.observer = "sim:threshold=1,lapse=0";
  Screen screen;
  session::Inputs inputs;
  const auto summary = session::run(session::prepare(request), &screen, inputs);
  REQUIRE(summary.status == core::SessionStatus::completed);
  for (const auto& trial : trials_of(request.database, summary.session_id)) {
    REQUIRE(trial.tones.front().interval_index == 0);
    CHECK(trial.tones.front().scene == "adaptor");
    CHECK(trial.tones.front().length_frames == frames(0.6));
    CHECK(trial.tones.back().interval_index == 1);
    REQUIRE(trial.given.response);
    CHECK(*trial.tones.back().boundary_mm == Approx(150 + std::stod(*trial.given.response)).margin(0.6));
    CHECK(std::abs(std::stod(*trial.given.response)) < 6);  // the setting that equals the standard is 0
  }
  int sliders = 0, before = 0;
  for (const auto& page : screen.pages) {
    sliders += page.kind == session::PageKind::adjust ? 1 : 0;
    before += page.kind == session::PageKind::stimulus ? 1 : 0;
  }
  CHECK(sliders >= 6);
  CHECK(before >= 6);
}

TEST_CASE("an interval of parts that lasts until the answer takes answers in its last part only",
          "[session][parts]") {
  const auto text =
      replaced(replaced(kAdaptation, "{ scene = \"test\", duration_s = 0.4 }", "{ scene = \"test\" }"),
               "response_zero = \"interval_off\"", "response_zero = \"go_cue\"\nexplore_s = 4.0");
  const auto protocol = protocol::parse(text, "p.toml");
  CHECK(protocol::explored(protocol.task));
  const auto spec = *trial::Director(protocol, 0, 5).next();
  trial::Machine machine(trial::timing_of(protocol, *trial::Director(protocol, 0, 5).block(), spec,
                                          trial::parts_of(protocol, spec)));
  constexpr std::int64_t ms = 1'000'000;
  machine.start(0);
  machine.handle({800 * ms, trial::EventKind::onset, 0});
  machine.handle({3500 * ms, trial::EventKind::onset, 1});
  machine.handle({1000 * ms, trial::EventKind::answer, 1});  // in the adaptor of 2 s
  machine.handle({3000 * ms, trial::EventKind::answer, 1});  // in the silence after it
  CHECK_FALSE(machine.result().response);
  CHECK(machine.result().extra_touches == 2);
  machine.handle({3900 * ms, trial::EventKind::answer, 1});
  CHECK(machine.result().response == 1);
  CHECK(machine.result().response_time_ns == 400 * ms);
  for (const auto& trial : session_of(text)) CHECK(trial.timing.response_time_s.value_or(0) > 0.1);
}

TEST_CASE(
    "the pause between trials and the foreperiod can be factors, and a foreperiod that tells the answer is "
    "found",
    "[session][parts][cues]") {
  const auto pauses = replaced(kPauses, "iti_s = 1.0", "iti_s = \"1 + isi_s\"");
  const auto protocol = protocol::parse(pauses, "p.toml");
  trial::Director with(protocol, 0, 3);
  for (int k = 0; k < 6; ++k) {
    const auto spec = *with.next();
    CHECK(spec.iti_s == 1 + number(spec.factors, "isi_s"));
    with.record({core::Outcome::answered, 0, true, {}, {}});
  }
  CHECK(said(protocol::notes(protocol)).find("decides the right answer") == std::string::npos);
  CHECK(said(protocol::notes(protocol::parse(
                 replaced(kPauses, "iti_s = 1.0", "iti_s = \"1 + 0.01 * offset_mm\""), "p.toml")))
            .find("the pause after a trial depends on \"offset_mm\"") != std::string::npos);
  auto change = replaced(
      kPauses,
      "kind = \"2ifc\"\nintervals = [\"adaptor\", \"test\"]\nduration_s = \"lead_s\"\ngap_s = \"2 * isi_s\"",
      "kind = \"single-interval\"\nintervals = [[\"adaptor\", \"test\"]]\nduration_s = 2.5\n"
      "foreperiod_s = \"isi_s\"\ntransition_ms = 50");
  change = replaced(change, "{ test = \"offset_mm > 0\", adaptor = \"offset_mm < 0\" }",
                    "{ first = \"offset_mm > 0\", second = \"offset_mm < 0\" }");
  const auto foreperiods = protocol::parse(change, "p.toml");
  trial::Director changes(foreperiods, 0, 3);
  const auto spec = *changes.next();
  CHECK(spec.foreperiod_s == number(spec.factors, "isi_s"));
  CHECK(trial::parts_of(foreperiods, spec).front().starts_s.front() == spec.foreperiod_s);
  CHECK(accuracy(change, "duration") < 0.55);
  CHECK(accuracy(replaced(change, "foreperiod_s = \"isi_s\"", "foreperiod_s = \"0.8 + 0.02 * offset_mm\""),
                 "duration") > 0.99);
}

TEST_CASE("check counts the parts, the silences and the long adaptors of a session", "[session][parts]") {
  const auto minutes = [](const std::string& text) {
    return rehearsal::session_length(protocol::parse(text, "p.toml"), 1).duration_s;
  };
  const double plain_s = minutes(kAdaptation);
  // 12 of 16 trials have the adaptor of 0.6 s on average, and the others that of 2 s
  CHECK(minutes(replaced(kAdaptation, "first_s = 2.0", "first_s = 7.0")) - plain_s ==
        Approx(4 * 5.0).margin(1e-6));
  CHECK(minutes(replaced(kAdaptation, "silence_s = 0.1", "silence_s = 1.1")) - plain_s ==
        Approx(16 * 1.0).margin(1e-6));
  CHECK(minutes(replaced(kPauses, "\"2 * isi_s\"", "\"2 * isi_s + 1\"")) - minutes(kPauses) ==
        Approx(16 * 1.0).margin(1e-6));
}

TEST_CASE(
    "the rig's limit of vibration without a rest counts every part and every length that a factor gives",
    "[session][parts]") {
  auto rig = thin_plate();
  rig.limits.continuous_s = 3;
  const auto problems = [&](const std::string& text) {
    return said(protocol::survey(protocol::parse(text, "p.toml"), rig).problems);
  };
  CHECK(problems(kAdaptation).empty());
  // 2.0 s, at least 0.35 s of silence, which is too short for a rest, and 1.5 s
  CHECK(problems(
            replaced(kAdaptation, "scene = \"test\", duration_s = 0.4", "scene = \"test\", duration_s = 1.5"))
            .find("tones last up to 3.85 s without a pause") != std::string::npos);
  CHECK(problems(replaced(kAdaptation, "first_s = 2.0", "first_s = 4.0"))
            .find("tones last up to 4.75 s without a pause") != std::string::npos);
  CHECK(problems(replaced(kPauses, "duration_s = \"lead_s\"", "duration_s = \"lead_s + 2.5\""))
            .find("tones last up to 3.2 s without a pause") != std::string::npos);
  // a silence of half a second is a rest
  CHECK(problems(replaced(replaced(kAdaptation, "silence_s = 0.1", "silence_s = 0.3"),
                          "scene = \"test\", duration_s = 0.4", "scene = \"test\", duration_s = 1.5"))
            .empty());
}

TEST_CASE("a length or a silence that tells the answer is found as a cue", "[session][parts][cues]") {
  CHECK(accuracy(kAdaptation, "duration") < 0.55);
  // longer where the answer is right
  CHECK(accuracy(replaced(kAdaptation, "scene = \"test\", duration_s = 0.4",
                          "scene = \"test\", duration_s = \"0.4 + 0.01 * offset_mm\""),
                 "duration") > 0.99);
  // the same total, but a longer silence and a shorter adaptor
  const auto same =
      replaced(replaced(kAdaptation, "silence_s = \"isi_s\"", "silence_s = \"0.5 + 0.01 * offset_mm\""),
               "duration_s = \"lead_s\"", "duration_s = \"0.5 - 0.01 * offset_mm\"");
  CHECK(accuracy(same, "duration") > 0.99);
  CHECK(accuracy(replaced(same, "0.5 - 0.01 * offset_mm", "0.5"), "duration") > 0.99);
}

TEST_CASE("what the scene in the middle of an interval gives away is found", "[session][parts][cues]") {
  // the first and the last scene are always the same, and the second one differs
  const auto text = replaced(kAdaptation, "{ scene = \"test\", duration_s = 0.4 },",
                             "{ scene = \"test\", duration_s = 0.4 },\n  { silence_s = 0.2 },\n"
                             "  { scene = \"adaptor\", duration_s = 0.4 },");
  const std::string cue = "stripe pitch at the wide end";
  CHECK(accuracy(text, cue) > 0.99);
  CHECK(accuracy(replaced(text, "{ scene = \"test\", duration_s = 0.4 }",
                          "{ scene = \"adaptor\", duration_s = 0.4 }"),
                 cue) < 0.55);
}

TEST_CASE("a difference of two scenes of an interval that is a rounding error tells nothing",
          "[session][parts][cues]") {
  // the same edge, so that its sharpness differs in the last digits at most
  const auto text = core::read_file(kSource + "/protocols/gallery/adaptation.toml");
  CHECK(accuracy(text, "edge sharpness", rig::load(kSource + "/deploy/rigs/simulated.toml")) < 0.55);
}

TEST_CASE("all parts of an interval are roved by the same share, and only those whose scenes allow it",
          "[session][parts]") {
  const auto text = replaced(kAdaptation, "boundary_mm = \"150 + offset_mm\"",
                             "boundary_mm = \"150 + offset_mm\"\nrove_dB = 2.0");
  const auto other = replaced(text, "displacement_um = 1.0", "displacement_um = 1.0\nrove_dB = 1.0");
  const auto alone = protocol::parse(text, "p.toml"), both = protocol::parse(other, "p.toml");
  trial::Director one(alone, 0, 3), two(both, 0, 3);
  double widest = 0;
  for (int k = 0; k < 6; ++k) {
    const auto a = *one.next(), b = *two.next();
    REQUIRE(a.rove_dB.size() == 2);
    CHECK(a.rove_dB[0] == 0);
    CHECK(b.rove_dB[1] == a.rove_dB[1]);
    CHECK(b.rove_dB[0] == Approx(0.5 * b.rove_dB[1]));
    widest = std::max(widest, std::abs(a.rove_dB[1]));
    one.record({core::Outcome::answered, 0, true, {}, {}}),
        two.record({core::Outcome::answered, 0, true, {}, {}});
  }
  CHECK(widest > 0.5);
  CHECK(widest <= 2);
}

TEST_CASE("a deadline is compared with the length at the same values of the factors", "[session][parts]") {
  const auto advice = [&](const std::string& deadline) {
    auto text = replaced(kPauses, "response_zero = \"interval_off\"", "response_zero = \"go_cue\"");
    return said(protocol::advice(protocol::parse(replaced(text, "deadline_s = 20.0", deadline), "p.toml")));
  };
  CHECK(advice("deadline_s = \"lead_s + 0.5\"").find("cannot be met") == std::string::npos);
  CHECK(advice("deadline_s = 0.8").find("cannot be met") != std::string::npos);
}

TEST_CASE("after a page of a fault, the next trial has the long adaptor again", "[session][parts]") {
  const TemporaryFolder folder;
  const auto path = written(folder, replaced(kAdaptation, "trials = 3", "trials = 50"));
  const auto ran = run(path, [&](int trial, simulation::Plant& plant) {
    if (trial == 4)
      plant.add({simulation::FaultKind::transducer_half, plant.frames() + 1, simulation::kNever, {}, 0});
  });
  REQUIRE(ran.trials.size() == 17);
  CHECK(ran.trials[4].outcome == core::Outcome::fault);
  CHECK(ran.faults.size() == 1);
  for (std::size_t i = 0; i < ran.trials.size(); ++i) {
    INFO("trial " << i);
    const bool is_long = i == 0 || i == 5 || i == 9;
    CHECK(stored_parts(ran.trials[i]).at(0).second ==
          frames(is_long ? 2.0 : number(ran.trials[i], "lead_s")));
  }
}

TEST_CASE("after a pause, the next trial has the long adaptor again", "[session][parts]") {
  using live_room::PageKind;
  struct Storing : session::Monitor {
    live_room::Room& room;
    int wanted;
    Storing(live_room::Room& in, int after) : room(in), wanted(after) {}
    void trial_ended(const trial::TrialSpec&, const core::TrialRow& row) override {
      if (row.outcome == core::Outcome::answered && --wanted == 0) room.push(session::input::Pause{});
    }
  };
  const int paused_after = GENERATE(0, 1);  // 0: never
  auto text =
      replaced(live_room::protocol_text("buttons"), "intervals = [\"edge\"]", "intervals = [\"pair\"]");
  text = replaced(text, "[timing]",
                  "[task.parts]\npair = [{ scene = \"edge\", duration_s = 0.2, first_s = 0.5 }, "
                  "{ silence_s = 0.1 }, { scene = \"edge\" }]\n[timing]");
  const TemporaryFolder folder;
  live_room::Room room;
  Storing storing(room, paused_after);
  auto setup = live_room::live_setup(folder / "a.sqlite");
  setup.protocol = protocol::parse(text, "live.toml");
  int faults = 0;  // of a machine that is too busy
  room.reacts = [&](const session::Page& page) {
    faults += page.kind == PageKind::fault ? 1 : 0;
    room.cooperate(page);  // answers in the first part are only touches
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices(), &storing);
  CHECK(summary.answered == 2);
  std::vector<core::TrialRow> answered;
  for (const auto& trial : live_room::trials_of(folder / "a.sqlite", summary))
    if (trial.outcome == core::Outcome::answered) answered.push_back(trial);
  REQUIRE(answered.size() == 2);
  CHECK(stored_parts(answered[0]).at(0).second == frames(0.5));
  if (paused_after == 1 || faults == 0)
    CHECK(stored_parts(answered[1]).at(0).second == frames(paused_after == 1 ? 0.5 : 0.2));
}

TEST_CASE("after a pause that the rig's limits have stretched by seconds, the adaptor is long again",
          "[session][parts]") {
  const TemporaryFolder folder;
  const auto request = simulated_run(written(folder, kAdaptation), folder / "a.sqlite", 5);
  auto setup = session::prepare(request);
  setup.rig.limits.duty = 0.06;  // 3.6 s in a minute
  session::Inputs nobody;
  const auto summary = session::run(setup, nullptr, nobody);
  REQUIRE(summary.status == core::SessionStatus::completed);
  const auto trials = trials_of(request.database, summary.session_id);
  int stretched = 0;
  for (const auto& event : store::read_session(request.database, summary.session_id).events) {
    if (event.kind != "interval_stretched" || std::stod(event.value) < 5) continue;
    ++stretched;
    CHECK(stored_parts(trials.at(static_cast<std::size_t>(event.trial_index.value()))).at(0).second ==
          frames(2.0));
  }
  CHECK(stretched > 3);
}

TEST_CASE("check finds exactly the trials that the rig can never present", "[session][parts]") {
  auto rig = thin_plate();
  rig.limits.continuous_s = 30, rig.limits.duty = 0.8;
  const auto two = [](const std::string& gap_s) {
    auto text = replaced(kPauses, "duration_s = \"lead_s\"\ngap_s = \"2 * isi_s\"", "gap_s = " + gap_s);
    text = replaced(text, "intervals = [\"adaptor\", \"test\"]", "intervals = [\"one\", \"two\"]");
    text = replaced(text, "{ test = \"offset_mm > 0\", adaptor = \"offset_mm < 0\" }",
                    "{ two = \"offset_mm > 0\", one = \"offset_mm < 0\" }");
    return replaced(text, "[timing]",
                    "[task.parts]\none = [{ scene = \"adaptor\", duration_s = 16.0 }]\n"
                    "two = [{ scene = \"test\", duration_s = 16.0 }]\n[timing]");
  };
  const auto parts = [](const std::string& list) {
    const auto begin = kAdaptation.find("adapted = ["), end = kAdaptation.find("[timing]");
    return kAdaptation.substr(0, begin) + "adapted = [" + list + "]\n" + kAdaptation.substr(end);
  };
  struct Case {
    std::string text, problem;
  };
  const std::vector<Case> cases = {
      {two("0.4"), "tones last up to 32.4 s without a pause"},
      {two("0.6"), ""},
      {two("0.5"), ""},
      {parts(
           "{ scene = \"adaptor\", duration_s = 18 }, { silence_s = 0.6 }, { scene = \"adaptor\", duration_s "
           "= 18 }, { silence_s = 0.6 }, { scene = \"test\", duration_s = 18 }"),
       "the tones of a trial last up to 54 s in 60 s"},
      // only one part of a trial is long
      {parts("{ scene = \"adaptor\", duration_s = 5, first_s = 20 }, { silence_s = 0.2 }, { scene = "
             "\"adaptor\", duration_s = 4, first_s = 20 }, { silence_s = 0.2 }, { scene = \"test\", "
             "duration_s = 0.4 }"),
       ""},
      {parts("{ scene = \"adaptor\", duration_s = 5, first_s = 26 }, { silence_s = 0.2 }, { scene = "
             "\"test\", duration_s = 4 }"),
       "tones last up to 30.2 s without a pause"},
      // where the first scene is long, the silence is a rest
      {parts("{ scene = \"adaptor\", duration_s = \"100 * lead_s - 45\" }, { silence_s = \"10 * lead_s - "
             "4.9\" }, { scene = \"test\", duration_s = 10 }"),
       ""},
      {parts("{ scene = \"adaptor\", duration_s = \"100 * lead_s - 45\" }, { silence_s = \"7.1 - 10 * "
             "lead_s\" }, { scene = \"test\", duration_s = 10 }"),
       "tones last up to 35.1 s without a pause"}};
  for (const auto& at : cases) {
    INFO(at.text);
    const auto protocol = protocol::parse(at.text, "p.toml");
    const auto found = said(protocol::survey(protocol, rig).problems);
    CHECK(found.empty() == at.problem.empty());
    CHECK(found.find(at.problem) != std::string::npos);
    // what the account of the finger says of a trial that comes alone
    bool refused = false;
    trial::Director director(protocol, 0, 3);
    for (int k = 0; k < 8; ++k) {
      const auto stimuli = session::stimuli_of(protocol, director.next().value());
      try {
        session::Exposure({1e-3, rig.limits.continuous_s, rig.limits.duty, 1e9}, 0)
            .earliest_start_s(0, stimuli);
      } catch (const session::LimitExceeded&) {
        refused = true;
      }
      director.record({core::Outcome::answered, 0, true, {}, {}});
    }
    if (at.problem.empty()) CHECK_FALSE(refused);
    if (at.problem.find("35.1") == std::string::npos) CHECK(refused == !at.problem.empty());
  }
}

TEST_CASE("a foreperiod is compared with the length at the same values of the factors", "[session][parts]") {
  auto text = replaced(
      kPauses,
      "kind = \"2ifc\"\nintervals = [\"adaptor\", \"test\"]\nduration_s = \"lead_s\"\ngap_s = \"2 * isi_s\"",
      "kind = \"single-interval\"\nintervals = [[\"adaptor\", \"test\"]]\nduration_s = \"isi_s + 0.5\"\n"
      "foreperiod_s = \"isi_s\"\ntransition_ms = 50");
  text = replaced(text, "{ test = \"offset_mm > 0\", adaptor = \"offset_mm < 0\" }",
                  "{ first = \"offset_mm > 0\", second = \"offset_mm < 0\" }");
  const auto advice = [](const std::string& of) {
    return said(protocol::advice(protocol::parse(of, "p.toml")));
  };
  CHECK(advice(text).find("the change can end") == std::string::npos);
  CHECK(advice(replaced(text, "\"isi_s + 0.5\"", "\"isi_s + 0.04\"")).find("the change can end") !=
        std::string::npos);
  CHECK_THROWS_AS(protocol::parse(replaced(text, "\"isi_s + 0.5\"", "\"0.5 * isi_s + 0.2\""), "p.toml"),
                  core::BadInput);
  // the end of the stimulus after the change is 0.5 s in all trials
  const auto end =
      protocol::stimulus_end(protocol::parse(replaced(text, "\"interval_off\"", "\"change\""), "p.toml"));
  REQUIRE(end);
  CHECK(end->earliest_s == Approx(0.5));
  CHECK(end->latest_s == Approx(0.5));
}

TEST_CASE("a deadline is compared with every part that can be the last one; rows name each part's interval",
          "[session][parts]") {
  auto text = replaced(kPauses, "duration_s = \"lead_s\"\n", "");
  text = replaced(text, "intervals = [\"adaptor\", \"test\"]", "intervals = [\"short\", \"long\"]");
  text = replaced(text, "{ test = \"offset_mm > 0\", adaptor = \"offset_mm < 0\" }", "\"long\"");
  text = replaced(
      text, "[timing]",
      "[task.parts]\nlong = [{ scene = \"adaptor\", duration_s = 0.3 }, { silence_s = 0.2 }, { scene = "
      "\"test\", duration_s = 0.8 }]\nshort = [{ scene = \"test\", duration_s = 0.4 }]\n[timing]");
  const auto advice = [&](const std::string& deadline) {
    const auto of = replaced(replaced(text, "response_zero = \"interval_off\"", "response_zero = \"go_cue\""),
                             "deadline_s = 20.0", deadline);
    return said(protocol::advice(protocol::parse(of, "p.toml")));
  };
  CHECK(advice("deadline_s = 0.6").find("up to 0.8 s after") != std::string::npos);
  CHECK(advice("deadline_s = 3.0").find("cannot be met") == std::string::npos);
  int swapped = 0;
  for (const auto& trial : session_of(text)) {
    const bool long_first = trial.tones.front().length_frames == frames(0.3);
    std::map<int, int> intervals;
    for (const auto& tone : trial.tones) intervals[tone.interval_index] = tone.of_interval;
    CHECK(intervals == (long_first ? std::map<int, int>{{0, 0}, {1, 0}, {2, 1}}
                                   : std::map<int, int>{{0, 0}, {1, 1}, {2, 1}}));
    swapped += long_first ? 1 : 0;
  }
  CHECK(swapped > 0);
}

namespace {

/// An adaptor before two intervals, longer in the first trial.
const std::string kBefore =
    replaced(replaced(kPauses, "duration_s = \"lead_s\"",
                      "before = [{ scene = \"adaptor\", duration_s = \"lead_s\", first_s = 2.0 }, "
                      "{ silence_s = 0.1 }, { scene = \"adaptor\", duration_s = 0.3 }, "
                      "{ silence_s = \"isi_s\" }]\nduration_s = 0.4"),
             "repeats = 4", "repeats = 2");

}  // namespace

TEST_CASE("one adaptor comes before both intervals of a trial, at the frames that the file states",
          "[session][parts][before]") {
  const auto trials = session_of(kBefore);
  REQUIRE(trials.size() == 8);
  for (std::size_t i = 0; i < trials.size(); ++i) {
    INFO("trial " << i);
    const auto parts = stored_parts(trials[i]);
    REQUIRE(parts.size() == 4);
    const double isi_s = number(trials[i], "isi_s");
    const bool is_long = i == 0 || i == 3 || i == 4;  // blocks of four, with a break after the third
    const std::int64_t lengths[] = {frames(is_long ? 2.0 : number(trials[i], "lead_s")), frames(0.3),
                                    frames(0.4), frames(0.4)};
    const std::int64_t silences[] = {0, frames(0.1), frames(isi_s), frames(2 * isi_s)};
    auto at = parts.at(0).first;
    for (int k = 0; k < 4; ++k) {
      at += silences[k];
      CHECK(parts.at(k).first == at);
      CHECK(parts.at(k).second == lengths[k]);
      at += lengths[k];
    }
    std::map<int, int> interval;
    for (const auto& tone : trials[i].tones) interval[tone.interval_index] = tone.of_interval;
    CHECK(interval == std::map<int, int>{{0, -1}, {1, -1}, {2, 0}, {3, 1}});
    CHECK(trials[i].tones.front().scene == "adaptor");
    CHECK(trials[i].timing.response_time_s.value_or(0) > 0);  // counted from the end of the second interval
  }
}

TEST_CASE("the page counts only the intervals, and what comes before them is none",
          "[session][parts][before]") {
  const TemporaryFolder folder;
  Screen screen;
  session::Inputs inputs;
  session::run(session::prepare(simulated_run(written(folder, kBefore), folder / "a.sqlite", 5)), &screen,
               inputs);
  std::vector<int> numbers;
  for (const auto& page : screen.pages) {
    if (page.kind != session::PageKind::stimulus) continue;
    CHECK(page.interval.of == 2);
    if (numbers.empty() || numbers.back() != page.interval.number) numbers.push_back(page.interval.number);
    if (numbers.size() == 6) break;
  }
  CHECK(numbers == std::vector<int>{0, 1, 2, 0, 1, 2});
}

TEST_CASE("a session with something before the intervals goes on with the same trials after a cut",
          "[session][parts][before]") {
  const TemporaryFolder folder;
  const auto file = written(folder, kBefore);
  session::Inputs inputs;
  const auto whole =
      session::run(session::prepare(simulated_run(file, folder / "whole.sqlite", 5)), nullptr, inputs);
  const auto expected = trials_of(folder / "whole.sqlite", whole.session_id);
  for (int page : {12, 17, 23}) {
    const auto name = "cut" + std::to_string(page) + ".sqlite";
    Screen cut(page);
    CHECK_THROWS_AS(session::run(session::prepare(simulated_run(file, folder / name, 5)), &cut, inputs),
                    std::runtime_error);
    std::ostringstream messages;
    const auto resumed = session::prepare_resume({folder / name, "", "resume", true}, messages);
    REQUIRE(resumed.has_value());
    const auto done = trials_of(folder / name, resumed->resume_session).size();
    const auto summary = session::run(*resumed, nullptr, inputs);
    CHECK(summary.status == core::SessionStatus::completed);
    const auto trials = trials_of(folder / name, summary.session_id);
    REQUIRE(trials.size() == expected.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      CHECK(trials[i].factors == expected[i].factors);
      CHECK(trials[i].given.response == expected[i].given.response);
      CHECK(trials[i].learned.state_hash == expected[i].learned.state_hash);
    }
    if (done < trials.size()) CHECK(stored_parts(trials[done]).at(0).second == frames(2.0));
  }
}

TEST_CASE("what comes before the intervals is limited, counted, measured and roved like them",
          "[session][parts][before]") {
  auto rig = thin_plate();
  rig.limits.continuous_s = 3.5;
  const auto problems = [&](const std::string& text) {
    return said(protocol::survey(protocol::parse(text, "p.toml"), rig).problems);
  };
  CHECK(problems(kBefore).empty());
  // 2.0 s, 0.1 s, 1.5 s, 0.25 s and 0.4 s; the pause of 0.5 s between the intervals is a rest
  CHECK(problems(replaced(kBefore, "duration_s = 0.3", "duration_s = 1.5"))
            .find("tones last up to 4.25 s without a pause") != std::string::npos);
  const auto seconds = [](const std::string& text) {
    return rehearsal::session_length(protocol::parse(text, "p.toml"), 1).duration_s;
  };
  CHECK(seconds(replaced(kBefore, "duration_s = 0.3", "duration_s = 1.3")) - seconds(kBefore) ==
        Approx(8 * 1.0).margin(1e-6));
  const TemporaryFolder folder;
  const auto ran = run(written(folder, kBefore), [](int, simulation::Plant&) {});
  REQUIRE(ran.trials.size() == 8);
  for (const auto& trial : ran.trials) {
    CHECK(trial.surface.proof == core::Proof::ok);
    for (const auto& tone : trial.tones) CHECK(std::abs(tone.measured_dB.value()) < 0.2);
  }
  const auto roved = replaced(kBefore, "displacement_um = 1.0", "displacement_um = 1.0\nrove_dB = 3.0");
  for (const auto& trial : session_of(roved)) {
    std::map<int, double> rove_dB;
    for (const auto& tone : trial.tones) rove_dB[tone.interval_index] = tone.rove_dB;
    CHECK(rove_dB.at(0) == rove_dB.at(1));  // one draw for what comes before
    CHECK(rove_dB.at(0) != rove_dB.at(2));
    CHECK(rove_dB.at(2) != rove_dB.at(3));
  }
}

TEST_CASE("what comes before the intervals changes nothing of what the search for cues finds in them",
          "[session][parts][before][cues]") {
  // the level decides which interval is right, so the adaptor can depend on it without telling the order
  const auto guard = [](const std::string& text) {
    const auto protocol = protocol::parse(text, "p.toml");
    return rehearsal::cue_guard(protocol, thin_plate(), protocol::survey(protocol, thin_plate()));
  };
  const auto without = guard(replaced(replaced(kPauses, "duration_s = \"lead_s\"", "duration_s = 0.4"),
                                      "repeats = 4", "repeats = 2"));
  const auto with = guard(kBefore);
  REQUIRE(with.reports.size() == without.reports.size());
  for (std::size_t i = 0; i < with.reports.size(); ++i) {
    CHECK(with.reports[i].cue == without.reports[i].cue);
    CHECK(with.reports[i].accuracy == Approx(without.reports[i].accuracy).margin(0.02));
  }
}

#include <sys/stat.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <fstream>
#include <mutex>

#include "station/core/number.hpp"
#include "station/core/proof.hpp"
#include "station/core/texts.hpp"
#include "station/report/svg.hpp"
#include "station/session/prepare.hpp"
#include "station/store/read.hpp"
#include "station/view/choices.hpp"
#include "station/view/live_view.hpp"
#include "tests/support/catch.hpp"
#include "tests/view/demo.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

view::LiveTrial answered(bool correct, double response_time_s) {
  view::LiveTrial trial;
  trial.procedure = "levels";
  trial.level = 4;
  trial.given.correct = correct;
  trial.timing.response_time_s = response_time_s;
  return trial;
}

/// A row of two parts: 1 s, and one of 25 s that changes after 2 s.
core::TrialRow two_parts(const std::string& zero, std::optional<double> response_time_s) {
  core::TrialRow row;
  const auto add = [&row](int interval, int scene, std::int64_t frames) {
    core::ToneRow tone;
    tone.interval_index = interval, tone.scene_index = scene, tone.length_frames = frames;
    row.tones.push_back(tone);
    tone.tone_index = 1;
    row.tones.push_back(tone);
  };
  add(0, 0, 1000), add(1, 0, 2000), add(1, 1, 23000);
  row.timing.response_zero = zero;
  row.timing.response_time_s = response_time_s;
  return row;
}

/// Passes the beginnings of the session's first trials on to another monitor, then ends the session.
struct FirstTrials : session::Monitor {
  session::Monitor& to;
  int left;
  FirstTrials(session::Monitor& monitor, int trials) : to(monitor), left(trials) {}
  void trial_begins(const trial::TrialSpec& spec, const protocol::Block& block,
                    const session::PlanAhead::Plans& plans) override {
    to.trial_begins(spec, block, plans);
  }
  void trial_ended(const trial::TrialSpec&, const core::TrialRow&) override {
    if (--left == 0) throw std::runtime_error("enough");
  }
};

/// Returns the drive amplitudes that the page shows, one for each tone, such as "0.512 um on", in order.
std::vector<std::string> drives_shown(const view::LiveState& state) {
  std::vector<std::string> drives;
  for (const auto& [label, value] : state.scene) {
    if (label != "Tone") continue;
    const auto from = value.find("drive ") + 6;
    drives.push_back(value.substr(from, value.find(" on ") + 3 - from));
  }
  return drives;
}

}  // namespace

TEST_CASE("the time of a stimulus ends with the answer in its last part, if that is explored", "[operator]") {
  const auto shown_s = [](const std::string& zero, std::optional<double> time_s, bool explored) {
    return view::stimulus_s(two_parts(zero, time_s), 1000, explored);
  };
  CHECK(shown_s("go_cue", 2.5, true) == Approx(1 + 2.5));
  CHECK(shown_s("change", 2.5, true) == Approx(1 + 2 + 2.5));
  CHECK(shown_s("go_cue", 40, true) == Approx(26));
  CHECK(shown_s("go_cue", std::nullopt, true) == Approx(26));
  CHECK(shown_s("interval_off", 0.5, true) == Approx(26));
  CHECK(shown_s("go_cue", 2.5, false) == Approx(26));
}

TEST_CASE("the progress of a session counts scored trials, and timeouts have no response time",
          "[operator]") {
  auto late = answered(false, 0);
  late.given.correct.reset();
  late.timing.response_time_s.reset();
  late.outcome = core::Outcome::timeout;
  auto caught = answered(true, 3);
  caught.type = core::TrialType::catch_trial;
  const auto facts =
      view::course_of({answered(true, 1), answered(false, 2), answered(true, 1.5), late, caught});
  CHECK(value_of(facts, "Trials") == "5");
  CHECK(value_of(facts, "Right") == "2 of 3 (66.7 %)");
  CHECK(value_of(facts, "Catch trials right") == "1 of 1");
  CHECK(value_of(facts, "Response time") == "median 1.75 s, last 3 s");
  CHECK(value_of(facts, "Too late, too early") == "1, 0");
  CHECK(value_of(view::course_of({}), "Right") == "none scored yet");
}

TEST_CASE("the progress of a session shows each procedure's latest estimate with its interval",
          "[operator]") {
  auto first = answered(true, 1), second = answered(true, 1), other = answered(true, 1),
       none = answered(true, 1);
  first.learned.threshold_est = 7, first.learned.threshold_sd = 3;
  second.learned.threshold_est = -1.5, second.learned.threshold_sd = 0.5;
  other.procedure = "ramp", other.learned.threshold_est = 2;
  const auto facts = view::course_of({first, second, other, none});
  CHECK(value_of(facts, "Estimate, levels") == "-1.5 (95 %: -2.48 to -0.52)");  // 1.96 SD = 0.98
  CHECK(value_of(facts, "Estimate, ramp") == "2");
  CHECK(value_of(view::course_of({none}), "Estimate, levels").empty());
}

TEST_CASE("the progress of a session shows what the pick-up measured in the last trial", "[operator]") {
  std::vector<view::LiveTrial> trials(2);
  const auto shown = [&](const std::string& language) {
    const auto label = core::say({"live.vibration", "", {}}, language);
    return value_of(view::course_of(trials, language), label);
  };
  CHECK(shown("en") == "not measured");
  trials.back().surface.proof = core::Proof::refused;
  trials.back().surface.proof_cause = core::ProofCause::dead;
  CHECK(shown("en") == "too far off: the trial is repeated; the surface does not move");
  CHECK(shown("de") == "zu weit daneben: der Durchgang wird wiederholt; die Oberfläche bewegt sich nicht");
  for (const char* language : {"en", "de", "es", "ja", "zh", "ar"})
    for (const auto verdict : core::proofs)
      for (const auto cause : core::proof_causes) {
        trials.back().surface.proof = verdict, trials.back().surface.proof_cause = cause;
        CHECK_FALSE(shown(language).empty());
      }
}

TEST_CASE("the used part of the limits is computed from the last minute", "[operator]") {
  rig::Rig rig;
  rig.limits.displacement_m = 8e-6;
  std::vector<view::LiveTrial> trials(3, answered(true, 1));
  for (int i = 0; i < 3; ++i) {
    trials[static_cast<std::size_t>(i)].timing.onset_s = 60.0 * i;
    trials[static_cast<std::size_t>(i)].stimulus_s = 15;
    trials[static_cast<std::size_t>(i)].timing.duration_s = 20;
  }
  const auto facts = view::limits_used(trials, 2e-6, rig);
  CHECK(value_of(facts, "Displacement") == "2 of 8 \u00b5m (25 %)");
  // The minute before 140 s contains only the trial that starts at 120 s.
  CHECK(value_of(facts, "Stimulus time, last minute") == "25 % (limit 80 %)");
}

TEST_CASE("the live view follows a session trial by trial and draws what is on the surface", "[operator]") {
  const TemporaryFolder folder;
  const auto setup = session::prepare(demo_in(folder));
  std::mutex mutex;
  std::condition_variable told;
  view::LiveState state;
  int news = 0;
  view::LiveView view(setup.protocol, setup.rig, [&](view::LiveState next) {
    const std::lock_guard lock(mutex);
    state = std::move(next);
    ++news;
    told.notify_one();
  });
  session::Inputs inputs;
  const auto summary = session::run(setup, nullptr, inputs, &view);
  std::unique_lock lock(mutex);
  told.wait(lock, [&] { return news == 2 * summary.trials; });
  CHECK(value_of(state.course, "Trials") == std::to_string(summary.trials));
  CHECK(state.heading.find("Block main, trial 10") == 0);
  // why no cheaper model was chosen: the tolerance that it would miss, and no other
  CHECK(value_of(state.scene, "Next cheaper model")
            .starts_with("mode would miss the scene's tolerance: level up to "));
  REQUIRE(state.surfaces.size() == 1);
  report::Svg drawn;
  state.surfaces.front()(drawn, 600, 120);
  CHECK(drawn.finish().find(" mm</text>") != std::string::npos);
  CHECK(state.trace);
  CHECK(state.times);
}

TEST_CASE("the live view shows what is played: each scene of each interval, with its roved amplitude",
          "[operator]") {
  const auto* protocol = GENERATE("demo", "speed-accuracy", "two-spots-oddity");
  CAPTURE(protocol);
  constexpr int trials = 6;
  const TemporaryFolder folder;
  auto request = demo_in(folder);
  request.protocol = kSource + "/protocols/" + protocol + ".toml";
  const auto setup = session::prepare(request);
  std::vector<view::LiveState> begun;
  {
    std::mutex mutex;
    std::condition_variable told;
    view::LiveView view(setup.protocol, setup.rig, [&](view::LiveState state) {
      const std::lock_guard lock(mutex);
      begun.push_back(std::move(state));
      told.notify_one();
    });
    FirstTrials first(view, trials);
    session::Inputs inputs;
    CHECK_THROWS(session::run(setup, nullptr, inputs, &first));
    std::unique_lock lock(mutex);
    told.wait(lock, [&] { return begun.size() == trials; });
  }
  const auto stored = view::interrupted_note(request.database);
  REQUIRE(stored.has_value());
  int trial = 0, roved = 0, scenes = 0;
  for (const auto& block : store::read_session(request.database, stored->session_id).blocks)
    for (const auto& row : block.trials) {
      const auto& state = begun.at(static_cast<std::size_t>(trial++));
      std::vector<std::string> played;
      scenes = 0;
      for (const auto& tone : row.tones) {
        played.push_back(core::number(tone.amplitude_um, 3) + " \u00b5m on");
        roved += tone.rove_dB != 0 ? 1 : 0;
        scenes += tone.tone_index == 0 ? 1 : 0;
      }
      CHECK(drives_shown(state) == played);
      CHECK(state.surfaces.size() == static_cast<std::size_t>(scenes));
    }
  CHECK(trial == trials);
  // negative control: there is roving or a trial with several scenes, so showing only the first scene without
  // roving would be wrong
  CHECK((roved > 0 || scenes > 1));
}

TEST_CASE("a slider that moves fast is shown a few times a second, and finally at its last position",
          "[operator]") {
  const TemporaryFolder folder;
  auto request = demo_in(folder);
  request.protocol = kSource + "/protocols/boundary-adjustment.toml";
  const auto setup = session::prepare(request);
  trial::Director director(setup.protocol, 0, 3);
  session::PlanAhead plans(setup.rig, setup.protocol, 3);
  auto spec = *director.next();
  std::mutex mutex;
  std::condition_variable told;
  std::vector<view::LiveState> states;
  view::LiveView view(setup.protocol, setup.rig, [&](view::LiveState state) {
    const std::lock_guard lock(mutex);
    states.push_back(std::move(state));
    told.notify_one();
  });
  const auto from = std::chrono::steady_clock::now();
  view.trial_begins(spec, *director.block(), plans.take(spec).plans);
  for (double offset_mm = -25; offset_mm < 25; offset_mm += 0.5) {
    spec.factors["offset_mm"] = offset_mm;
    view.surface_follows(spec, plans.take(spec).plans.front().back());
  }
  std::unique_lock lock(mutex);
  CHECK(told.wait_for(lock, std::chrono::seconds(20), [&] {
    return !states.empty() && states.back().heading.find(", now 24.5:") != std::string::npos;
  }));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - from;
  // one state at the start, one with the final setting, and the others at least 200 ms apart
  CHECK(states.size() <= 2 + took / std::chrono::milliseconds(200));
  const auto plan = plans.take(spec).plans.front().back();
  CHECK(drives_shown(states.back()) ==
        std::vector<std::string>{core::number(1e6 * plan.tones.front().amplitude_m, 3) + " \u00b5m on"});
  CHECK(states.back().surfaces.size() == 1);
}

TEST_CASE("new studies are saved with the protocols or, if that is not possible, beside the database",
          "[desk]") {
  const TemporaryFolder folder;
  const auto database = folder / "data/lab.sqlite";
  const auto own = folder / "data/protocols", shipped = folder / "shipped";
  CHECK(view::folder_for_studies(folder.path, database) == folder.path);
  CHECK(view::folder_for_studies(folder / "none", database) == own);
  std::filesystem::create_directories(own);
  std::filesystem::create_directories(shipped);
  std::filesystem::copy_file(TURNPOINT_SOURCE_DIR "/protocols/demo.toml", own + "/mine.toml");
  CHECK(view::list_studies(shipped, database).empty());
  if (::geteuid() == 0) return;  // root may write into every folder
  ::chmod(shipped.c_str(), 0555);
  const auto list = view::list_studies(shipped, database);
  ::chmod(shipped.c_str(), 0755);
  REQUIRE(list.size() == 1);
  CHECK(list[0].path == own + "/mine.toml");
}

TEST_CASE("the list of protocol files in a folder includes those that cannot be used", "[operator]") {
  const TemporaryFolder folder;
  fs::copy_file(kSource + "/protocols/demo.toml", folder / "a.toml");
  std::ofstream(folder / "b.toml") << "format = 3\n";
  std::ofstream(folder / "notes.txt") << "no protocol\n";
  const auto list = view::list_protocols(folder.path);
  REQUIRE(list.size() == 2);
  CHECK(list[0].id == "demo");
  CHECK(list[0].languages.size() == 3);
  REQUIRE_FALSE(list[1].problems.empty());
  CHECK(core::say(list[1].problems.front(), "en").find("b.toml: ") != std::string::npos);
}

TEST_CASE("an unusable entry among the protocols has a message and does not hide the others", "[operator]") {
  const TemporaryFolder folder;
  const auto shipped = std::string(TURNPOINT_SOURCE_DIR) + "/protocols/demo.toml";
  fs::copy_file(shipped, folder / "demo.toml");
  fs::create_symlink("/nowhere/at/all", folder / "dangling.toml");
  fs::create_symlink("anna@host.1234", folder / ".#demo.toml");
  fs::create_directory(folder / "folder.toml");
  REQUIRE(::mkfifo((folder / "pipe.toml").c_str(), 0600) == 0);
  const auto list = view::list_protocols(folder.path);
  REQUIRE(list.size() == 4);
  for (const auto& entry : list) {
    INFO(entry.path);
    CHECK(entry.problems.empty() == (entry.id == "demo"));
  }
}

TEST_CASE("participants are listed once they have a stored session, and an interrupted session is offered",
          "[operator]") {
  const TemporaryFolder folder;
  const auto request = demo_in(folder);
  CHECK(view::known_participants(request.database).empty());
  CHECK_FALSE(view::interrupted_note(request.database).has_value());
  struct Cut : session::Monitor {
    int left = 3;
    void trial_ended(const trial::TrialSpec&, const core::TrialRow&) override {
      if (--left == 0) throw std::runtime_error("cut");
    }
  } cut;
  session::Inputs inputs;
  CHECK_THROWS(session::run(session::prepare(request), nullptr, inputs, &cut));
  CHECK(view::known_participants(request.database) == std::vector<std::string>{"P09"});
  const auto note = view::interrupted_note(request.database);
  REQUIRE(note.has_value());
  CHECK(note->participant == "P09");
  CHECK(note->trials == 3);
}

TEST_CASE("the description of a check begins with the cues that could give answers away", "[operator]") {
  rehearsal::Check check;
  check.cues.reports = {{"pitch", 0, 0, "Hz", 0.5, 0.5}, {"loudness", 0, 1, "dB", 0.9, 0.5}};
  const auto words = view::words_of(check);
  REQUIRE(words.cues.size() == 2);
  CHECK(core::say(words.cues[0].name, "en") == "loudness");
  CHECK(core::say(words.cues[0].says, "en") == "90 % right with this cue alone (chance 50 %)");
  CHECK(core::say(words.cues[0].says, "de") == "90 % richtig nur mit diesem Hinweisreiz (Zufall 50 %)");
  CHECK(words.cues[0].leaks);
  CHECK_FALSE(words.cues[1].leaks);
  check.problems.push_back({{"a.toml", 3, 1}, core::plain("what"), core::plain("allowed")});
  CHECK(view::words_of(check).facts.empty());
  CHECK(core::say(view::words_of(check).problems.front(), "en") == "a.toml:3:1: what; allowed");
}

TEST_CASE("the facts of a check are said in each language, with the names from the protocol", "[operator]") {
  rehearsal::Check check;
  check.rig_name = "plate";
  check.duration_s = {300, 360, 480};
  check.blocks = {
      {"session 2, group trained", 2, "trained", "main", "speed", false, {20, 20, 20}, {60, 90, 150}}};
  const auto said = [&](const char* language) {
    std::vector<std::string> lines;
    for (const auto& [label, value] : view::words_of(check).facts)
      lines.push_back(core::say(label, language) + ": " + core::say(value, language));
    return lines;
  };
  using Lines = std::vector<std::string>;
  CHECK(said("en") == Lines{"Rig: plate", "Trials: 0", "Duration: 6 (5 to 8) min",
                            "Block: session 2, group trained: main (speed), trials: 20, 1.5 (1 to 2.5) min"});
  CHECK(said("de") ==
        Lines{"Aufbau: plate", "Durchgänge: 0", "Dauer: 6 (5 bis 8) min",
              "Block: Sitzung 2, Gruppe trained: main (speed), Durchgänge: 20, 1.5 (1 bis 2.5) min"});
}

TEST_CASE("each part of a session has its length for a card, with the figures of the check", "[operator]") {
  using Kind = protocol::InterludeKind;
  rehearsal::Check check;
  const auto block = [&](const char* visit, const char* name, rehearsal::Spread trials,
                         rehearsal::Spread duration_s) {
    check.blocks.push_back({visit, 0, "", name, "", false, trials, duration_s});
  };
  const auto says = [&](const char* kind, const char* name, const char* language = "en") {
    return core::say(view::words_of(check).lengths.at({kind, name}), language);
  };
  block("", "practice", {6, 6, 6}, {61, 61, 62});
  block("", "main", {40, 44, 50}, {400, 480, 600});
  check.blocks.front().before = {
      {Kind::consent, "form", 1}, {Kind::explanation, "intro", 3}, {Kind::screening, "who", 0}};
  check.blocks.back().after = {{Kind::questionnaire, "after", 4}};
  CHECK(says("block", "practice") == "Trials: 6   ·   1 min");
  CHECK(says("block", "main") == "Trials: 44 (40 to 50)   ·   8 (6.7 to 10) min");
  CHECK(says("block", "main", "de") == "Durchgänge: 44 (40 bis 50)   ·   8 (6.7 bis 10) min");
  CHECK(says("consent", "form") == "Pages: 1");
  CHECK(says("explanation", "intro") == "Pages: 3");
  CHECK(says("questionnaire", "after") == "Questions: 4");
  CHECK(view::words_of(check).lengths.count({"screening", "who"}) == 0);

  SECTION("the blocks of a sequence are said together") {
    check.blocks.clear();
    for (const double s : {300, 360, 360, 300}) block("", "main", {84, 84, 84}, {s, s, s});
    CHECK(says("block", "main") == "Trials: 4 \u00d7 84   ·   4 \u00d7 5\u20136 min");
  }
  SECTION("a block of several visits is said once") {
    check.blocks.clear();
    for (const char* visit : {"session 1", "session 2"}) block(visit, "main", {84, 84, 84}, {300, 300, 300});
    CHECK(says("block", "main") == "Trials: 84   ·   5 min");
    block("session 2", "main", {80, 84, 84}, {300, 300, 300});
    CHECK(says("block", "main") == "Trials: 1\u20132 \u00d7 80\u201384   ·   1\u20132 \u00d7 5 min");
  }
  SECTION("while there is a mistake nothing is known") {
    check.problems.push_back({{"a.toml", 3, 1}, core::plain("what"), core::plain("allowed")});
    CHECK(view::words_of(check).lengths.empty());
  }
}

TEST_CASE("a check that is no longer wanted is abandoned before it plans anything", "[operator]") {
  std::stop_source stop;
  const auto check = [&] {
    return rehearsal::check(kSource + "/protocols/friction-2ifc.toml",
                            kSource + "/tests/support/thin_plate.toml", {}, stop.get_token());
  };
  CHECK(check().problems.empty());
  stop.request_stop();
  CHECK_THROWS_AS(check(), protocol::Abandoned);
}

TEST_CASE("preparing a session that is no longer wanted is abandoned before it plans anything",
          "[operator]") {
  const TemporaryFolder folder;
  std::stop_source stop;
  CHECK(session::prepare(demo_in(folder), stop.get_token()).participant == "P09");
  stop.request_stop();
  CHECK_THROWS_AS(session::prepare(demo_in(folder), stop.get_token()), protocol::Abandoned);
}

TEST_CASE("ages are formatted as people say them", "[operator]") {
  CHECK(view::age_in_words(30) == "30 s old");
  CHECK(view::age_in_words(600) == "10 min old");
  CHECK(view::age_in_words(3 * 3600) == "3 h old");
  CHECK(view::age_in_words(80 * 3600) == "3 days old");
  CHECK(view::age_in_words(-5) == "dated in the future: a clock was wrong");
}

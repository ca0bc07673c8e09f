// Trials whose intervals are presented again because the participant asks for it: the same samples again,
// each presentation measured and limited like the first, and what is stored of them.
#include <algorithm>
#include <cmath>
#include <fstream>

#include "station/core/read_file.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/survey.hpp"
#include "station/rehearsal/check.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/session/resume.hpp"
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

/// Two intervals, of which the one with the target has two parts.
const std::string kTwo = R"(format = "friction-protocol/1"
[protocol]
id = "again"
version = "1"
title = "Again"
languages = ["en"]
[[factor]]
name = "offset_mm"
range = [-20.0, 20.0]
[[factor]]
name = "gap_s"
levels = [0.6, 0.9]
[scene.plain]
boundary_mm = 150.0
edge = "p50"
displacement_um = 1.0
rove_dB = 2.0
[scene.edge]
base = "plain"
boundary_mm = "150 + offset_mm"
[task]
kind = "2ifc"
intervals = ["plain", "pattern"]
duration_s = 0.5
gap_s = "gap_s"
again = 2
device = "touch"
question = { en = "Which?" }
choices = [{ id = "first", label = { en = "First" } }, { id = "second", label = { en = "Second" } }]
correct = "pattern"
[task.parts]
pattern = [{ scene = "plain", duration_s = 0.2 }, { silence_s = 0.1 }, { scene = "edge", duration_s = 0.3 }]
[timing]
response_zero = "interval_off"
deadline_s = 6.0
iti_s = 1.0
[[procedure]]
name = "levels"
kind = "constant-stimuli"
level = "offset_mm"
values = [6.0, 12.0]
repeats = 3
[[block]]
name = "main"
procedures = ["levels"]
)";

std::int64_t frames_of(double s) { return std::llround(s * kRate_Hz); }

struct Session {
  std::vector<core::TrialRow> trials;
  std::vector<core::EventRow> events;
};

Session session_of(const std::string& text, const std::string& observer, double duty = 0.8,
                   session::Display* display = nullptr) {
  const TemporaryFolder folder;
  auto request = simulated_run(written(folder, text), folder / "a.sqlite", 5);
  request.observer = observer;
  auto setup = session::prepare(request);
  setup.rig.limits.duty = duty;
  session::Inputs nobody;
  const auto summary = session::run(setup, display, nobody);
  REQUIRE(summary.status == core::SessionStatus::completed);
  return {trials_of(request.database, summary.session_id),
          store::read_session(request.database, summary.session_id).events};
}

std::string said(const std::vector<core::Problem>& problems) {
  std::string all;
  for (const auto& problem : problems) all += core::format(problem) + "\n";
  return all;
}

/// A rig with a third response button.
struct ThreeButtons : io::Buttons {
  const std::vector<std::string> all{"left", "right", "third"};
  const std::vector<std::string>& names() const override { return all; }
  std::string missing() const override { return ""; }
  void simulate(const io::Press&) override {}
  void simulate(const io::Contact&) override {}
};

/// What the file says is wrong with it; "" if nothing.
std::string refused(const std::string& text) {
  try {
    protocol::parse(text, "p.toml");
  } catch (const core::BadInput& bad) {
    return said(bad.problems());
  }
  return "";
}

}  // namespace

TEST_CASE("each time the intervals are asked for, the same tones are presented at the same distances",
          "[session][again]") {
  const auto once = session_of(kTwo, "sim").trials, thrice = session_of(kTwo, "sim:again=1").trials;
  REQUIRE(once.size() == 6);
  REQUIRE(thrice.size() == 6);
  for (std::size_t k = 0; k < once.size(); ++k) {
    INFO("trial " << k);
    const auto &one = once[k], &three = thrice[k];
    CHECK(one.given.again == 0);
    CHECK(three.given.again == 2);
    // what is asked, answered and learned does not depend on how often it was felt
    CHECK(three.factors == one.factors);
    CHECK(three.given.response == one.given.response);
    CHECK(three.learned.state_hash == one.learned.state_hash);
    CHECK(three.timing.response_time_s.value() == Approx(one.timing.response_time_s.value()).margin(1e-6));
    const auto parts = one.tones.size();
    REQUIRE(parts == 3);
    REQUIRE(three.tones.size() == 3 * parts);
    for (std::size_t i = 0; i < three.tones.size(); ++i) {
      const auto &tone = three.tones[i], &as = one.tones[i % parts];
      CHECK(tone.interval_index == static_cast<int>(i));
      CHECK(tone.of_interval == as.of_interval);
      CHECK(tone.scene == as.scene);
      CHECK(tone.frequency_Hz == as.frequency_Hz);
      CHECK(tone.displacement_um == as.displacement_um);
      CHECK(tone.rove_dB == as.rove_dB);
      CHECK(tone.length_frames == as.length_frames);
      CHECK(tone.onset_frame - three.tones[i - i % parts].onset_frame ==
            as.onset_frame - one.tones.front().onset_frame);
    }
    // response_zero is the end of the last interval of the last presentation
    const auto& last = three.tones.back();
    const auto& first = three.tones.front();
    const double from_first_s =
        static_cast<double>(last.onset_frame + last.length_frames - first.onset_frame) / kRate_Hz;
    CHECK(three.timing.duration_s > from_first_s + *three.timing.response_time_s + 1.0);
    CHECK(last.onset_frame > three.tones[5].onset_frame + frames_of(0.8));
  }
}

TEST_CASE("a rehearsal asks for the intervals again as often as a session, and takes as long",
          "[session][again]") {
  const auto protocol = protocol::parse(kTwo, "p.toml");
  for (const char* observer : {"sim:again=0.5", "sim:again=1", "sim"}) {
    INFO(observer);
    const auto session = session_of(kTwo, observer).trials;
    const auto rehearsal = rehearsal::rehearse(
        protocol, {}, 5, rehearsal::rehearser(simulation::Observer(simulation::parse(observer))));
    const auto& rehearsed = rehearsal.blocks.front().trials;
    REQUIRE(rehearsed.size() == session.size());
    for (std::size_t k = 0; k < session.size(); ++k) {
      CHECK(rehearsed[k].given.again == session[k].given.again);
      CHECK(rehearsed[k].given.response == session[k].given.response);
      CHECK(rehearsed[k].timing.duration_s == Approx(session[k].timing.duration_s).margin(0.3));
    }
  }
}

TEST_CASE("a simulated observer asks again with the probability that it was told, each time that it may",
          "[session][again][observer]") {
  const simulation::Observer observer(simulation::parse("sim:again=0.3,lapse=0"));
  simulation::Question question;
  question.correct = 0;
  question.again = 2;
  constexpr int trials = 20'000;
  int counts[3] = {};
  for (int k = 0; k < trials; ++k) {
    question.key = {11, core::Stream::observer, 0, 0, k};
    ++counts[observer.answer(question).again];
  }
  // binomial: three standard deviations of 20 000 draws are 1 % at most
  CHECK(counts[0] / double(trials) == Approx(0.7).margin(0.01));
  CHECK(counts[1] / double(trials) == Approx(0.3 * 0.7).margin(0.01));
  CHECK(counts[2] / double(trials) == Approx(0.09).margin(0.01));
  question.again = 0;
  CHECK(observer.answer(question).again == 0);
  CHECK_THROWS_AS(simulation::parse("sim:again=1.5"), core::UsageError);
}

TEST_CASE("pick-ups measure every presentation, and one that is too weak makes the trial void",
          "[session][again][proof]") {
  const TemporaryFolder folder;
  const auto path = written(folder, kTwo);
  const bool broken = GENERATE(false, true);
  How how;
  how.observer = "sim:again=1";
  const auto ran = run(
      path,
      [&](int trial, simulation::Plant& plant) {
        // The plant counts only frames that are captured: 1.4 s for each presentation, so this is in the
        // second.
        if (broken && trial == 2)
          plant.add({simulation::FaultKind::transducer_half,
                     plant.frames() + frames_of(1.9),
                     simulation::kNever,
                     {},
                     0});
      },
      how);
  CHECK(ran.trials.size() == (broken ? 7 : 6));
  for (const auto& trial : ran.trials) {
    INFO("trial " << trial.trial_index);
    if (broken && trial.trial_index == 2) {
      CHECK(trial.outcome == core::Outcome::fault);
      // the fault begins within an interval, whose second half is too weak
      CHECK((trial.surface.proof == core::Proof::refused || trial.surface.proof == core::Proof::stopped));
      CHECK_FALSE(trial.given.response);
      CHECK(trial.given.again.value() > 0);
      REQUIRE(trial.tones.front().measured_dB);
      CHECK(std::abs(*trial.tones.front().measured_dB) < 0.2);  // the first presentation was as planned
      CHECK(std::abs(trial.surface.drive_ratio_dB.value()) > 1);
      continue;
    }
    CHECK(trial.surface.proof == core::Proof::ok);
    CHECK(trial.given.again == 2);
    REQUIRE(trial.tones.size() == 9);
    for (const auto& tone : trial.tones) {
      REQUIRE(tone.measured_dB);
      CHECK(std::abs(*tone.measured_dB) < 0.2);
    }
  }
  if (broken) CHECK(ran.trials[2].factors == ran.trials[3].factors);
}

TEST_CASE("the finger is measured in every presentation, and the row has that of the last one",
          "[session][again][forces]") {
  const TemporaryFolder folder;
  How how;
  how.observer = "sim:again=1";
  how.capture = kCells;
  const auto text =
      replaced(replaced(kTwo, "values = [6.0, 12.0]", "values = [12.0]"), "repeats = 3", "repeats = 1");
  const auto ran = run(
      written(folder, text), [](int, simulation::Plant&) {}, how);
  REQUIRE(ran.trials.size() == 1);
  CHECK(ran.trials[0].given.again == 2);
  CHECK(ran.trials[0].outcome == core::Outcome::answered);
  CHECK(ran.trials[0].finger.contact_s.value() > 0);
}

TEST_CASE("a session that is cut while intervals are presented again goes on with the same trials",
          "[session][again]") {
  const TemporaryFolder folder;
  const auto file = written(folder, kTwo);
  const auto request = [&](const std::string& database) {
    auto asked = simulated_run(file, folder / database, 5);
    asked.observer = "sim:again=0.6";
    return asked;
  };
  session::Inputs inputs;
  Screen all;
  const auto whole = session::run(session::prepare(request("whole.sqlite")), &all, inputs);
  const auto expected = trials_of(folder / "whole.sqlite", whole.session_id);
  // The pages at which the intervals are presented again: a cue that follows the question.
  std::vector<int> cuts;
  for (std::size_t i = 1; i < all.pages.size(); ++i)
    if (all.pages[i].kind == session::PageKind::cue && all.pages[i - 1].kind == session::PageKind::response)
      for (int later : {1, 2, 4}) cuts.push_back(static_cast<int>(i) + later);
  REQUIRE(cuts.size() >= 6);
  for (const int page : cuts) {
    INFO("cut at page " << page);
    const auto name = "cut" + std::to_string(page) + ".sqlite";
    Screen cut(page);
    CHECK_THROWS_AS(session::run(session::prepare(request(name)), &cut, inputs), std::runtime_error);
    std::ostringstream messages;
    const auto resumed = session::prepare_resume({folder / name, "", "resume", true}, messages);
    REQUIRE(resumed.has_value());
    const auto summary = session::run(*resumed, nullptr, inputs);
    CHECK(summary.status == core::SessionStatus::completed);
    const auto trials = trials_of(folder / name, summary.session_id);
    REQUIRE(trials.size() == expected.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      CHECK(trials[i].factors == expected[i].factors);
      CHECK(trials[i].given.again == expected[i].given.again);
      CHECK(trials[i].given.response == expected[i].given.response);
      CHECK(trials[i].learned.state_hash == expected[i].learned.state_hash);
    }
  }
}

TEST_CASE("the rig's duty limits the vibration of all presentations together", "[session][again]") {
  const auto text = replaced(kTwo, "duration_s = 0.5\n", "duration_s = 1.5\n");
  constexpr double duty = 0.06;  // 3.6 s in a minute; a presentation has 1.5 s and 0.5 s
  const auto session = session_of(text, "sim:again=1", duty);
  std::vector<std::pair<double, double>> on;
  int within = 0;
  for (const auto& event : session.events) {
    if (event.kind == "interval_stretched") ++within;
    if (event.kind != "stimulus") continue;
    const double at_s = 1e-9 * static_cast<double>(event.time_ns);
    on.emplace_back(at_s, at_s + std::stod(event.value));
  }
  CHECK(on.size() == 6 * 9);
  CHECK(within >= 12);  // most presentations had to wait
  for (const auto& [from_s, to_s] : on) {
    double sum_s = 0;
    for (const auto& [begin_s, end_s] : on)
      sum_s += std::max(0.0, std::min(end_s, to_s) - std::max(begin_s, to_s - 60));
    CHECK(sum_s <= duty * 60 + 1e-6);
  }
  for (const auto& trial : session.trials) CHECK(trial.given.again == 2);
}

TEST_CASE("the page offers the intervals again while an answer is open, until they have been had",
          "[session][again][pages]") {
  Screen screen;
  session_of(kTwo, "sim:again=1", 0.8, &screen);
  int offered = 0, asked = 0;
  for (const auto& page : screen.pages) {
    if (page.kind == session::PageKind::response) ++asked, offered += page.again ? 1 : 0;
    if (page.kind != session::PageKind::response) CHECK_FALSE(page.again);
  }
  CHECK(asked == 6 * 3);
  CHECK(offered == 6 * 2);
  Screen without;
  session_of(replaced(kTwo, "again = 2\n", ""), "sim:again=1", 0.8, &without);
  CHECK(
      std::none_of(without.pages.begin(), without.pages.end(), [](const auto& page) { return page.again; }));
}

TEST_CASE("a person asks on the screen or with the third button, and answers afterwards in real time",
          "[session][again][live]") {
  using live_room::PageKind;
  const bool by_button = GENERATE(false, true);
  auto text = replaced(live_room::protocol_text("buttons"), "device = \"buttons\"",
                       "again = 1\nduration_s = 0.2\ndevice = \"buttons\"");
  text = replaced(text, "explore_s = 2.0\n", "");
  text = replaced(text, "response_zero = \"go_cue\"", "response_zero = \"interval_off\"");
  const TemporaryFolder folder;
  live_room::Room room;
  auto setup = live_room::live_setup(folder / "a.sqlite");
  setup.protocol = protocol::parse(text, "live.toml");
  auto devices = room.devices();
  int asked = 0;
  room.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::instructions || page.kind == PageKind::paused)
      room.push(session::input::Next{});
    if (page.kind == PageKind::fault)
      room.push(page.amplifier.empty() ? session::input::Any(session::input::Next{}) : session::input::Arm{});
    if (page.kind != PageKind::response) return;
    if (page.again && by_button)
      ++asked, room.press(2);
    else if (page.again)
      ++asked, room.push(session::input::Again{});
    else
      room.push(session::input::Button{0}, 100'000'000);
  };
  if (by_button) devices.buttons = std::make_unique<ThreeButtons>();
  const auto summary = session::run(setup, &room, room.inputs, std::move(devices));
  CHECK(summary.answered == 2);
  CHECK(asked >= 2);
  for (const auto& trial : live_room::trials_of(folder / "a.sqlite", summary)) {
    if (trial.outcome != core::Outcome::answered) continue;
    CHECK(trial.given.again == 1);
    CHECK(trial.given.extra_touches == 0);
    REQUIRE(trial.tones.size() == 2);
    // about 0.1 s after the end of the second presentation, long after the first one
    CHECK(trial.timing.response_time_s.value() < 0.6);
    CHECK(trial.tones[1].onset_frame - trial.tones[0].onset_frame > frames_of(0.2 + 0.5));
  }
  CHECK(room.enables().size() >= 8);  // the amplifier was switched on and off for each presentation
}

TEST_CASE("check says how long trials and the session become, and where people have to wait",
          "[session][again][check]") {
  const auto protocol = protocol::parse(kTwo, "p.toml");
  auto rig = rig::parse(core::read_file(kSource + "/tests/support/thin_plate.toml"), "rig.toml");
  CHECK(said(protocol::survey(protocol, rig).warnings).find("people wait") == std::string::npos);
  rig.limits.duty = 0.04;  // 2.4 s in a minute; the tones of a presentation last 1.0 s
  const auto warned = said(protocol::survey(protocol, rig).warnings);
  CHECK(warned.find("the tones of a trial that is presented 3 times would last up to 3 s in 60 s") !=
        std::string::npos);
  CHECK(
      said(
          protocol::survey(protocol::parse(replaced(kTwo, "again = 2", "again = 1"), "p.toml"), rig).warnings)
          .find("people wait") == std::string::npos);
  const TemporaryFolder folder;
  rehearsal::CheckOptions options;
  options.sessions = 4;
  const auto rig_path = kSource + "/tests/support/thin_plate.toml";
  const auto check = rehearsal::check(written(folder, kTwo), rig_path, options);
  REQUIRE(check.problems.empty());
  // Cue, intervals with the longer pause, and the answer of the first and of two more presentations
  constexpr double presented_s = 0.8 + 0.5 + 0.9 + 0.6;
  CHECK(check.longest_trial_again_s.value() > 3 * presented_s + 1.0);
  CHECK(check.longest_trial_again_s.value() < 3 * (presented_s + 6.0) + 1.0);
  CHECK(check.longest_session_again_s.value() > check.duration_s.high + 6 * 2 * (presented_s - 0.3));
  const auto without =
      rehearsal::check(written(folder, replaced(kTwo, "again = 2\n", "")), rig_path, options);
  CHECK_FALSE(without.longest_trial_again_s);
  CHECK(without.duration_s.median == check.duration_s.median);
}

TEST_CASE("intervals cannot be asked for again at a response signal, nor in an adjustment",
          "[session][again]") {
  CHECK(refused(kTwo).empty());
  const auto signal =
      replaced(kTwo, "deadline_s = 6.0", "response_signal = { after_s = 0.5, window_s = 0.4 }");
  CHECK(refused(signal).find("\"again\" does not apply with \"response_signal\"") != std::string::npos);
  CHECK(refused(replaced(kTwo, "again = 2", "again = 21")).find("20") != std::string::npos);
  CHECK(refused(replaced(kTwo, "again = 2", "again = 0")).find("p.toml") != std::string::npos);
}

namespace {

/// The standard, a silence, and a scene that the slider changes; people may go back to the standard.
const std::string kMatching = R"(format = "friction-protocol/1"
[protocol]
id = "match"
version = "1"
title = "Match"
languages = ["en"]
[[factor]]
name = "offset_mm"
range = [-20.0, 20.0]
[scene.standard]
boundary_mm = 150.0
edge = "p50"
displacement_um = 1.0
[scene.test]
base = "standard"
boundary_mm = "150 + offset_mm"
[task]
kind = "adjustment"
intervals = ["pair"]
again = 2
adjusts = "offset_mm"
step = 0.5
device = "touch"
question = { en = "Make the second one like the first." }
choices = [{ id = "done", label = { en = "Done" } }]
[task.parts]
pair = [{ scene = "standard", duration_s = 0.2 }, { silence_s = 0.1 }, { scene = "test" }]
[timing]
response_zero = "go_cue"
explore_s = 4.0
deadline_s = 8.0
iti_s = 0.3
[[procedure]]
name = "settings"
kind = "adjustment"
level = "offset_mm"
start_below = [-10.0]
start_above = [10.0]
repeats = 1
[[block]]
name = "main"
procedures = ["settings"]
)";

/// The same, as the second of two tasks.
std::string second_task() {
  auto text = replaced(kMatching, "[task]\n", R"([tasks.judge]
kind = "single-interval"
intervals = ["test"]
duration_s = 0.2
device = "touch"
question = { en = "Left?" }
choices = [{ id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } }]
correct = { left = "offset_mm < 0", right = "offset_mm > 0" }
[tasks.match]
)");
  text = replaced(text, "[task.parts]", "[tasks.match.parts]");
  text = replaced(text, "[[procedure]]\n", R"([[procedure]]
name = "sides"
task = "judge"
kind = "constant-stimuli"
level = "offset_mm"
values = [-8.0, 8.0]
repeats = 1
[[procedure]]
task = "match"
)");
  return text + "[[block]]\nname = \"sides\"\nprocedures = [\"sides\"]\n";
}

}  // namespace

TEST_CASE("in an adjustment people go back to the standard, and then to the setting that they had made",
          "[session][again][live]") {
  using live_room::PageKind;
  const TemporaryFolder folder;
  live_room::Room room;
  auto setup = live_room::live_setup(folder / "a.sqlite", "touch");
  const bool second = GENERATE(false, true);
  setup.protocol = protocol::parse(second ? second_task() : kMatching, "live.toml");
  constexpr double moved = 4.5;
  /// Asks for the standard again once the surface has followed the slider.
  struct Asking : session::Monitor {
    live_room::Room& room;
    int asked = 0;
    explicit Asking(live_room::Room& in) : room(in) {}
    void surface_follows(const trial::TrialSpec&, const scene::DrivePlan&) override {
      ++asked;
      room.push(session::input::Again{}, 200'000'000);
    }
  } asking(room);
  std::vector<session::Page> returned;
  room.reacts = [&](const session::Page& page) {
    if (page.kind == PageKind::instructions || page.kind == PageKind::paused)
      room.push(session::input::Next{});
    if (page.kind == PageKind::fault)
      room.push(page.amplifier.empty() ? session::input::Any(session::input::Next{}) : session::input::Arm{});
    if (page.kind == PageKind::response) room.push(session::input::Answer{0}, 100'000'000);
    if (page.kind != PageKind::adjust || page.answers_open) return;
    if (page.slider.setting != moved) {
      CHECK_FALSE(page.slider.moved);
      CHECK(page.again);
      room.push(session::input::Slider{moved});
      return;
    }
    returned.push_back(page);
    room.push(session::input::Next{}, 300'000'000);
  };
  const auto summary = session::run(setup, &room, room.inputs, room.devices(), &asking);
  REQUIRE(summary.answered == (second ? 4 : 2));
  CHECK(asking.asked >= 2);
  CHECK(returned.size() >= 2);
  for (const auto& page : returned) {
    CHECK(page.slider.moved);
    CHECK(page.again);  // once more
  }
  for (const auto& trial : live_room::trials_of(folder / "a.sqlite", summary)) {
    if (trial.outcome != core::Outcome::answered) continue;
    if (trial.procedure == "sides") {  // its task does not offer it
      CHECK_FALSE(trial.given.again);
      continue;
    }
    CHECK(trial.given.again == 1);
    CHECK(std::stod(trial.given.response.value()) == moved);
    std::map<std::pair<int, int>, const core::ToneRow*> scenes;
    for (const auto& tone : trial.tones)
      if (tone.tone_index == 0) scenes[{tone.interval_index, tone.scene_index}] = &tone;
    REQUIRE(scenes.count({3, 0}) == 1);
    CHECK(scenes.at({0, 0})->scene == "standard");
    CHECK(scenes.at({2, 0})->scene == "standard");
    CHECK(scenes.at({2, 0})->frequency_Hz == scenes.at({0, 0})->frequency_Hz);
    CHECK(scenes.at({1, 0})->boundary_mm.value() == Approx(150 + trial.level.value()));
    CHECK(scenes.at({1, 1})->boundary_mm.value() == Approx(150 + moved));
    CHECK(scenes.at({3, 0})->boundary_mm.value() == Approx(150 + moved));
    // the first adjustment was cut off before the standard came again
    const auto& cut = *scenes.at({1, 1});
    CHECK(cut.length_frames < frames_of(1.0));
    CHECK(cut.onset_frame + cut.length_frames < scenes.at({2, 0})->onset_frame);
    CHECK(trial.timing.response_time_s.value() < 1.5);  // from the onset of the scene that is set
  }
}

TEST_CASE("a simulated observer goes back to the standard before it sets the slider, and sets the same",
          "[session][again]") {
  const auto text = replaced(replaced(kMatching, "explore_s = 4.0", "explore_s = 25.0"), "deadline_s = 8.0",
                             "deadline_s = 40.0");
  const auto once = session_of(text, "sim").trials, thrice = session_of(text, "sim:again=1").trials;
  REQUIRE(once.size() == 2);
  REQUIRE(thrice.size() == 2);
  for (std::size_t k = 0; k < once.size(); ++k) {
    CHECK(thrice[k].given.again == 2);
    CHECK(thrice[k].given.response == once[k].given.response);
    CHECK(thrice[k].tones.back().interval_index == 5);
    CHECK(thrice[k].timing.response_time_s.value() ==
          Approx(once[k].timing.response_time_s.value()).margin(1e-6));
  }
  const auto rehearsal =
      rehearsal::rehearse(protocol::parse(text, "p.toml"), {}, 5,
                          rehearsal::rehearser(simulation::Observer(simulation::parse("sim:again=1"))));
  for (std::size_t k = 0; k < thrice.size(); ++k) {
    const auto& trial = rehearsal.blocks.front().trials.at(k);
    CHECK(trial.given.again == 2);
    CHECK(trial.given.response == thrice[k].given.response);
    CHECK(trial.timing.duration_s == Approx(thrice[k].timing.duration_s).margin(0.3));
  }
}

TEST_CASE("a surface that follows the finger follows it in each presentation, and the trial has the last one",
          "[session][again][follow]") {
  const TemporaryFolder folder;
  auto text = core::read_file(shipped("edge-anywhere"));
  const auto cut = text.find("[[procedure]]");
  text = text.substr(0, cut) + "[[block]]\nname = \"short\"\nlevel = \"step\"\nlevels = [0.5]\n";
  text = replaced(text, "gap_s = 1.0", "gap_s = 1.0\nagain = 1");
  auto request = simulated_run(written(folder, text), folder / "a.sqlite", 3);
  request.rig = kSource + "/deploy/rigs/simulated-following.toml";
  request.observer = "sim:again=1";
  session::Inputs nobody;
  const auto summary = session::run(session::prepare(request), nullptr, nobody);
  REQUIRE(summary.status == core::SessionStatus::completed);
  const auto trials = trials_of(request.database, summary.session_id);
  REQUIRE(trials.size() == 1);
  const auto& trial = trials.front();
  REQUIRE(trial.given.again == 1);
  CHECK(trial.follow.followed == "ok");
  CHECK(trial.follow.share.value() > 0.9);
  CHECK(trial.surface.proof == core::Proof::ok);  // of all four intervals, with the gains that were commanded
  CHECK(trial.follow.envelope_error_dB.value() < -20);
  std::map<int, std::int64_t> onsets;
  for (const auto& tone : trial.tones) onsets[tone.interval_index] = tone.onset_frame;
  REQUIRE(onsets.size() == 4);
  store::Database database(request.database, store::Database::Access::read_only);
  for (const auto* stream : {core::kFollowStream, core::kEnvelopeStream}) {
    INFO(stream);
    store::SignalReader reader(database, summary.session_id, stream);
    const auto signal = reader.next();
    REQUIRE(signal);
    CHECK(std::abs(signal->row.start_frame - onsets.at(2)) < 192);
    CHECK_FALSE(reader.next());
  }
}

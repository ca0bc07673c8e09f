// Sessions with several tasks: what the pages say before, during and after a trial of each, that a session
// that was cut goes on, and that the order of one task's intervals tells nothing of the other's.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>

#include "station/protocol/tasks.hpp"
#include "station/session/resume.hpp"
#include "station/session/session.hpp"
#include "station/store/read.hpp"
#include "station/trial/director.hpp"
#include "tests/session/screen.hpp"
#include "tests/session/stored_trials.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

namespace {

using session::PageKind;

const std::string kHead = R"(format = "friction-protocol/1"
[protocol]
id = "tasks"
version = "1"
title = "Two tasks"
languages = ["en"]
[[factor]]
name = "offset_mm"
range = [-20.0, 20.0]
[[factor]]
name = "weber"
range = [0.0, 3.0]
[scene.edge]
boundary_mm = "150 + offset_mm"
edge = "p50"
displacement_um = 1.0
[scene.usual]
base = "edge"
boundary_mm = 150.0
[scene.strong]
base = "usual"
displacement_um = "1 + weber"
[timing]
response_zero = "interval_off"
deadline_s = 8.0
iti_s = 0.5
)";

const std::string kSide = R"([tasks.side]
kind = "single-interval"
intervals = ["edge"]
duration_s = 0.8
device = "touch"
cue = { en = "Which side?" }
question = { en = "Left or right?" }
choices = [{ id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } }]
correct = { left = "offset_mm < 0", right = "offset_mm > 0" }
)";

/// A task of two intervals, of this name.
std::string which(const std::string& name) {
  return "[tasks." + name + "]\n" + R"(kind = "2ifc"
intervals = ["usual", "strong"]
duration_s = 0.8
gap_s = 0.6
device = "touch"
cue = { en = ")" +
         name + R"(!" }
question = { en = "Which one was )" +
         name + R"(?" }
choices = [{ id = "first", label = { en = "First" } }, { id = "second", label = { en = "Second" } }]
correct = "strong"
)";
}

std::string procedure(const std::string& name, const std::string& task, const std::string& level,
                      const std::string& values) {
  return "[[procedure]]\nname = \"" + name + "\"\ntask = \"" + task +
         "\"\nkind = \"constant-stimuli\"\nlevel = \"" + level + "\"\nvalues = " + values +
         "\nrepeats = 12\n";
}

std::string mixed(const std::string& interleave, const std::string& procedures) {
  return "[[block]]\nname = \"mixed\"\nprocedures = " + procedures + "\ninterleave = \"" + interleave +
         "\"\nbreak_after = { trials = 5, min_s = 1 }\n";
}

const std::string kTwoTasks =
    kHead + kSide + which("smoother") + procedure("sides", "side", "offset_mm", "[-8.0, 8.0]") +
    procedure("steps", "smoother", "weber", "[0.4, 0.8]") + mixed("random", "[\"sides\", \"steps\"]");

/// The request for a session of two tasks.
session::RunRequest request_for(const TemporaryFolder& folder, const std::string& database) {
  std::ofstream(folder / "tasks.toml") << kTwoTasks;
  return simulated_run(folder / "tasks.toml", folder / database, 5);
}

}  // namespace

TEST_CASE("pages say which task comes, and have the question and the answers of that task",
          "[session][tasks]") {
  const TemporaryFolder folder;
  Screen screen;
  session::Inputs inputs;
  const auto summary = session::run(session::prepare(request_for(folder, "a.sqlite")), &screen, inputs);
  REQUIRE(summary.status == core::SessionStatus::completed);
  const auto trials = trials_of(folder / "a.sqlite", summary.session_id);
  REQUIRE(trials.size() == 48);
  const auto& before = screen.pages.front();
  CHECK(before.kind == PageKind::instructions);
  CHECK(before.text == "Left or right?\n\nWhich one was smoother?");
  std::vector<session::Page> cues;
  for (const auto& page : screen.pages) {
    if (page.kind == PageKind::cue) cues.push_back(page);
    if (page.kind != PageKind::response) continue;
    REQUIRE(!cues.empty());
    const bool side = cues.back().cue == "Which side?";
    CHECK(page.text == (side ? "Left or right?" : "Which one was smoother?"));
    REQUIRE(page.answers.size() == 2);
    CHECK(page.answers[0].id == (side ? "left" : "first"));
    CHECK(page.interval.of == (side ? 1 : 2));
  }
  REQUIRE(cues.size() == trials.size());
  for (std::size_t i = 0; i < trials.size(); ++i)
    CHECK(cues[i].cue == (trials[i].procedure == "sides" ? "Which side?" : "smoother!"));
}

TEST_CASE("a session of two tasks that is cut at any page goes on with the same trials", "[session][tasks]") {
  const TemporaryFolder folder;
  session::Inputs inputs;
  const auto whole = session::run(session::prepare(request_for(folder, "whole.sqlite")), nullptr, inputs);
  const auto expected = trials_of(folder / "whole.sqlite", whole.session_id);
  REQUIRE(expected.size() == 48);
  for (int page = 9; page < 100; page += 13) {
    INFO("cut at page " << page);
    const auto name = "cut" + std::to_string(page) + ".sqlite";
    Screen cut(page);
    CHECK_THROWS_AS(session::run(session::prepare(request_for(folder, name)), &cut, inputs),
                    std::runtime_error);
    std::ostringstream messages;
    const auto resumed = session::prepare_resume({folder / name, "", "resume", true}, messages);
    REQUIRE(resumed.has_value());
    const auto summary = session::run(*resumed, nullptr, inputs);
    CHECK(summary.status == core::SessionStatus::completed);
    const auto trials = trials_of(folder / name, summary.session_id);
    REQUIRE(trials.size() == expected.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      CHECK(trials[i].procedure == expected[i].procedure);
      CHECK(trials[i].factors == expected[i].factors);
      CHECK(trials[i].correct_response == expected[i].correct_response);
      CHECK(trials[i].given.response == expected[i].given.response);
      CHECK(trials[i].learned.state_hash == expected[i].learned.state_hash);
    }
  }
}

TEST_CASE("the order of the intervals of one task tells nothing of those of the other", "[session][tasks]") {
  const auto protocol = protocol::parse(
      kHead + which("smoother") + which("stronger") + procedure("one", "smoother", "weber", "[0.4, 0.8]") +
          procedure("other", "stronger", "weber", "[0.4, 0.8]") + mixed("alternate", "[\"one\", \"other\"]"),
      "tasks.toml");
  REQUIRE(protocol.by_task.size() == 2);
  int same = 0, pairs = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    trial::Director director(protocol, {}, seed);
    std::map<std::string, std::vector<int>> right;
    while (const auto spec = director.next()) {
      right[spec->procedure].push_back(*spec->correct);
      CHECK(protocol::of_task(protocol, spec->task).task.name ==
            (spec->procedure == "one" ? "smoother" : "stronger"));
      director.record({core::Outcome::answered, 0, *spec->correct == 0});
    }
    REQUIRE(right["one"].size() == 24);
    REQUIRE(right["other"].size() == 24);
    for (auto& [name, choices] : right)  // each order equally often in every twelve trials of a task
      for (const auto from : {0, 12})
        CHECK(std::count(choices.begin() + from, choices.begin() + from + 12, 0) == 6);
    for (std::size_t i = 0; i < 24; ++i, ++pairs) same += right["one"][i] == right["other"][i];
  }
  // 960 pairs: a half, within four standard errors
  CHECK(std::abs(same - pairs / 2) < 62);
}

TEST_CASE("the long adaptor comes in the first trial of each task after the block began and after a rest",
          "[session][tasks]") {
  const auto before =
      "before = [{ scene = \"usual\", duration_s = 0.5, first_s = 5.0 }, { silence_s = 0.6 }]\n";
  const auto text =
      kHead + kSide + which("smoother") + before + procedure("sides", "side", "offset_mm", "[-8.0, 8.0]") +
      procedure("steps", "smoother", "weber", "[0.4, 0.8]") + mixed("alternate", "[\"sides\", \"steps\"]");
  const auto protocol = protocol::parse(text, "p.toml");
  trial::Director director(protocol, {}, 3);
  std::vector<int> fresh;  // numbers of the trials with the long adaptor
  for (int k = 0; k < 20; ++k) {
    if (k == 7) director.rested();
    const auto spec = director.next();
    REQUIRE(spec);
    REQUIRE(spec->procedure == (k % 2 == 0 ? "sides" : "steps"));
    if (spec->fresh) fresh.push_back(k);
    director.record({core::Outcome::answered, 0, *spec->correct == 0});
  }
  CHECK(fresh == std::vector<int>{1, 7});
}

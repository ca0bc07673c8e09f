// Points for answers, delays after errors, blocks of a fixed time, goals with what is said at their end, and
// answers of people who do not want to guess.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "station/core/read_file.hpp"
#include "station/rehearsal/rehearsal.hpp"
#include "station/session/prepare.hpp"
#include "station/session/resume.hpp"
#include "station/session/scores.hpp"
#include "station/session/session.hpp"
#include "station/simulation/observer.hpp"
#include "station/store/read.hpp"
#include "tests/session/screen.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;

namespace {

const std::string kPayoff = R"(
[payoff]
right = 10
wrong = "-2 * cost"
late = -20
early = -7
fast = { below_s = 0.7, points = 5 }
text = { en = "You have earned € %1" }
worth = 0.01
decimals = 2
)";

/// Two blocks of a fixed time, one for each cost of an error.
std::string protocol_text(const std::string& payoff = kPayoff, const std::string& lasts_s = "30.0",
                          const std::string& feedback = "trial",
                          const std::string& delays = "{ wrong = 2.5, late = 4.0, early = 3.0 }") {
  return R"(format = "friction-protocol/1"
[protocol]
id = "points"
version = "1.0.0"
title = "Points"
languages = ["en"]
[random]
seed = 7
[[factor]]
name = "offset_mm"
range = [-24.0, 24.0]
[[factor]]
name = "cost"
levels = [1, 5]
[scene.edge]
boundary_mm = "160 + offset_mm"
edge = "p50"
displacement_um = 1.0
[task]
kind = "single-interval"
intervals = ["edge"]
device = "touch"
question = { en = "Left or right?" }
choices = [{ id = "left", label = { en = "Left" } }, { id = "right", label = { en = "Right" } }]
correct = { left = "offset_mm < 0", right = "offset_mm > 0" }
[timing]
response_zero = "go_cue"
explore_s = 2.0
deadline_s = 1.0
iti_s = 0.5
anticipation_s = 0.2
delay_s = )" +
         delays + payoff + R"(
[instructions.quick]
text = { en = "Quickly." }
goal = { accuracy_above = 0.85, median_time_below_s = 0.6 }
[[procedure]]
name = "levels"
kind = "constant-stimuli"
level = "offset_mm"
values = [-6.0, -1.0, 1.0, 6.0]
repeats = 40
[[block]]
name = "practice"
procedures = ["levels"]
trials = 4
practice = true
feedback = ")" +
         feedback + R"("
[[sequence]]
name = "main"
design = "latin-square"
over = "cost"
block = { procedures = ["levels"], lasts_s = )" +
         lasts_s + ", instruction = \"quick\", feedback = \"" + feedback + "\" }\n";
}

struct Station {
  TemporaryFolder folder;
  std::string database = folder / "points.sqlite", protocol = folder / "points.toml";

  explicit Station(const std::string& text) { std::ofstream(protocol) << text; }

  session::Setup setup(const std::string& observer) const {
    auto request = simulated_run(protocol, database);
    request.observer = observer;
    return session::prepare(request);
  }
};

/// What the protocol above says that a trial is worth.
double worth(const core::TrialRow& row) {
  const double cost = std::get<double>(row.factors.at("cost"));
  switch (row.outcome) {
    case core::Outcome::timeout:
      return -20;
    case core::Outcome::anticipation:
      return -7;
    default:
      return !row.given.correct.value() ? -2 * cost : *row.timing.response_time_s < 0.7 ? 15 : 10;
  }
}

session::Summary run(const session::Setup& setup, Screen& screen) {
  session::Inputs inputs;
  return session::run(setup, &screen, inputs);
}

/// Pulls the plug at this page, and goes on with the session by the policy.
session::Summary run_cut(const Station& station, const std::string& observer, int page,
                         const std::string& policy, Screen& rest) {
  Screen cut(page);
  CHECK_THROWS(run(station.setup(observer), cut));
  std::ostringstream messages;
  const auto again = session::prepare_resume({station.database, "", policy, true}, messages);
  REQUIRE(again);
  return run(*again, rest);
}

constexpr const char* kCareless = "sim:threshold=6,anticipation=0.25,bound=1.2";

}  // namespace

TEST_CASE("each trial is worth what the protocol says, and the score is the sum outside practice",
          "[session]") {
  const Station station(protocol_text());
  Screen screen;
  const auto summary = run(station.setup(kCareless), screen);
  CHECK(summary.status == core::SessionStatus::completed);
  const auto stored = store::read_session(station.database, summary.session_id);
  double score = 0;
  std::set<double> seen;
  for (const auto& block : stored.blocks)
    for (const auto& row : block.trials) {
      REQUIRE(row.given.points);
      CHECK(*row.given.points == worth(row));
      seen.insert(*row.given.points);
      score += block.start.practice ? 0 : *row.given.points;
    }
  CHECK(seen.count(15) == 1);
  CHECK(seen.count(10) == 1);
  CHECK(seen.count(-20) == 1);
  CHECK(seen.count(-7) == 1);
  CHECK((seen.count(-2) == 1 && seen.count(-10) == 1));
  REQUIRE(summary.points);
  CHECK(*summary.points == Approx(score));
  const auto said =
      fmt::format("You have earned € {}{:.2f}", score < 0 ? "\u2212" : "", std::fabs(0.01 * score));
  CHECK(screen.pages.back().text.find(said) != std::string::npos);
}

TEST_CASE("feedback after a trial says its points, and the score outside practice", "[session]") {
  const Station station(protocol_text());
  Screen screen;
  run(station.setup(kCareless), screen);
  int right = 0, scores = 0;
  for (const auto& page : screen.pages) {
    if (page.kind != session::PageKind::feedback) continue;
    if (page.correct == true) {
      ++right;
      CHECK((page.text.find("0.15") != std::string::npos || page.text.find("0.10") != std::string::npos));
      CHECK(page.text.find("+") != std::string::npos);
    } else {
      CHECK(page.text.find("\u2212") != std::string::npos);
    }
    scores += page.text.find("You have earned") != std::string::npos ? 1 : 0;
  }
  CHECK(right > 3);
  CHECK(scores > 3);
  // without feedback after trials, nobody learns points before the end
  const Station silent(protocol_text(kPayoff, "30.0", "none"));
  Screen other;
  run(silent.setup(kCareless), other);
  for (const auto& page : other.pages)
    if (page.kind == session::PageKind::feedback) CHECK(page.text.find("\u2212") == std::string::npos);
}

TEST_CASE("a block of a fixed time ends with the trial in which its time is up", "[session]") {
  const Station station(protocol_text());
  Screen screen;
  const auto summary = run(station.setup("sim"), screen);
  const auto stored = store::read_session(station.database, summary.session_id);
  REQUIRE(stored.blocks.size() == 3);
  CHECK(stored.blocks[0].trials.size() == 4);
  for (std::size_t b = 1; b < 3; ++b) {
    double before_s = 0;
    for (const auto& row : stored.blocks[b].trials) {
      CHECK(before_s < 30);
      before_s += row.timing.duration_s;
    }
    CHECK(before_s >= 30);
  }
}

TEST_CASE("the pause is longer after a wrong, a late and an early answer", "[session]") {
  const Station station(protocol_text());
  Screen screen;
  const auto summary = run(station.setup(kCareless), screen);
  std::map<std::string, int> kinds;
  for (const auto& block : store::read_session(station.database, summary.session_id).blocks)
    for (const auto& row : block.trials) {
      // 0.8 s of cue, the answer, 0.8 s of feedback or 1 s of the late message, a pause of 0.5 s
      const bool answered = row.outcome == core::Outcome::answered;
      const double zero_s = 0.8, pause_s = 0.5 + (answered ? 0.8 : 1.0);
      if (answered) {
        ++kinds[*row.given.correct ? "right" : "wrong"];
        CHECK(row.timing.duration_s ==
              Approx(zero_s + *row.timing.response_time_s + pause_s + (*row.given.correct ? 0 : 2.5))
                  .margin(0.2));
      } else if (row.outcome == core::Outcome::timeout) {
        ++kinds["late"];
        CHECK(row.timing.duration_s == Approx(zero_s + 1.0 + pause_s + 4.0).margin(0.2));
      } else {
        ++kinds["early"];
        CHECK(row.timing.duration_s < zero_s + 0.2 + pause_s + 3.0 + 0.2);
        CHECK(row.timing.duration_s > pause_s + 3.0);
      }
    }
  CHECK(kinds.size() == 4);
}

TEST_CASE("a session that is cut in a block of a fixed time goes on with its time and its score",
          "[session]") {
  const Station whole(protocol_text());
  Screen screen;
  const auto expected = run(whole.setup(kCareless), screen);
  const auto trials = [](const Station& station, const session::Summary& summary) {
    std::vector<core::TrialRow> all;
    for (const auto& block : store::read_session(station.database, summary.session_id).blocks)
      all.insert(all.end(), block.trials.begin(), block.trials.end());
    return all;
  };
  const auto rows = trials(whole, expected);
  for (const int page : {40, 75, static_cast<int>(screen.pages.size()) - 12}) {
    INFO("cut at page " << page);
    const Station station(protocol_text());
    Screen rest;
    const auto summary = run_cut(station, kCareless, page, "resume", rest);
    CHECK(summary.status == core::SessionStatus::completed);
    const auto found = trials(station, summary);
    REQUIRE(found.size() == rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) CHECK(found[i].given.points == rows[i].given.points);
    CHECK(summary.points == expected.points);
    CHECK(rest.pages.back().text == screen.pages.back().text);
  }
}

TEST_CASE("a block or a session that starts again gives no points for what was abandoned", "[session]") {
  for (const auto* policy : {"block", "restart"}) {
    double abandoned = 0;
    for (const int page : {60, 75}) {
      INFO(policy << ", cut at page " << page);
      const Station station(protocol_text());
      Screen rest;
      const auto summary = run_cut(station, kCareless, page, policy, rest);
      CHECK(summary.status == core::SessionStatus::completed);
      double all = 0;
      std::map<int, std::pair<int, double>> blocks;  // the newest attempt and its points
      for (const auto& block : store::read_session(station.database, summary.session_id).blocks) {
        auto& [attempt, points] = blocks[block.start.block_index];
        if (block.start.attempt > attempt) attempt = block.start.attempt, points = 0;
        for (const auto& row : block.trials)
          if (!block.start.practice && row.given.points)
            points += *row.given.points, all += *row.given.points;
      }
      double newest = 0;
      for (const auto& [index, block] : blocks) newest += block.second;
      CHECK(summary.points == Approx(newest));
      abandoned += std::fabs(all - newest);
    }
    CHECK(abandoned > 0);
  }
}

TEST_CASE("the goal is said before a block, and after it whether it was reached", "[session]") {
  const auto told = [](const char* observer, const std::string& feedback) {
    const Station station(protocol_text(kPayoff, "60.0", feedback));
    Screen screen;
    run(station.setup(observer), screen);
    for (const auto& page : screen.pages)
      if (page.kind == session::PageKind::instructions && page.title == "Get ready")
        CHECK(page.text.find("Goal: more than 85 % correct\nGoal: time below 0.6 s") != std::string::npos);
    return screen.titled("End of this part");
  };
  const auto good = told("sim:threshold=0.2,lapse=0,bound=0.3,residual=0.2", "none");
  REQUIRE(good.size() == 2);
  CHECK(good.front().text.find("You have reached the goal.") != std::string::npos);
  CHECK(good.front().text.find("You have earned €") != std::string::npos);
  const auto slow = told("sim:threshold=0.2,lapse=0,bound=0.3,residual=0.6", "none");
  REQUIRE(slow.size() == 2);
  CHECK(slow.front().text.find("You have not reached the goal yet.") != std::string::npos);
  // with the feedback "block", practice has such a page too, without a score
  const auto all = told("sim:threshold=20", "block");
  REQUIRE(all.size() == 3);
  CHECK(all.front().text.find("Correct: ") == 0);
  CHECK(all.front().text.find("earned") == std::string::npos);
  CHECK(all.back().text.find("You have not reached the goal yet.") != std::string::npos);
}

TEST_CASE("a rehearsal gives the points of the session", "[session]") {
  const Station station(protocol_text());
  Screen screen;
  const auto setup = station.setup(kCareless);
  const auto summary = run(setup, screen);
  const auto stored = store::read_session(station.database, summary.session_id);
  const auto rehearsal = rehearsal::rehearse(
      setup.protocol, {}, 7, rehearsal::rehearser(simulation::Observer(simulation::parse(kCareless))));
  REQUIRE(rehearsal.blocks.size() == stored.blocks.size());
  for (std::size_t b = 0; b < stored.blocks.size(); ++b) {
    const auto &a = stored.blocks[b].trials, &c = rehearsal.blocks[b].trials;
    // frames of the drive make a trial some microseconds longer, so that the last one may differ
    REQUIRE(std::max(a.size(), c.size()) - std::min(a.size(), c.size()) <= 1);
    for (std::size_t i = 0; i < std::min(a.size(), c.size()); ++i)
      CHECK(a[i].given.points == c[i].given.points);
  }
}

TEST_CASE("scores leave out voids and warm-ups, take the newest attempt, and start again with the session",
          "[session]") {
  session::Scores scores;
  core::TrialRow right;
  right.correct_response = right.given.response = "a";
  right.given.correct = true, right.given.points = 2, right.timing.response_time_s = 0.5;
  auto late = right;
  late.outcome = core::Outcome::timeout, late.given.correct.reset(), late.timing.response_time_s.reset(),
  late.given.points = -1;
  auto fault = right;
  fault.outcome = core::Outcome::fault, fault.given.correct.reset(), fault.given.points.reset();
  auto warmup = right;
  warmup.type = core::TrialType::warmup;
  const core::BlockStart practice{0, 0, "practice", "", true}, first{1, 0, "main", "", false},
      second{2, 0, "main", "", false};
  scores.begin(practice);
  for (const auto& row : {right, late, fault, warmup}) scores.add(practice, row);
  CHECK(scores.of(0).accuracy() == 0.5);
  CHECK(scores.of(0).median_time_s() == 0.5);
  CHECK(scores.points() == 0);
  scores.begin(first), scores.add(first, right), scores.add(first, late);
  scores.begin(second), scores.add(second, right);
  CHECK(scores.points() == 3);
  CHECK(scores.accuracies().at("main") == Approx(2.0 / 3));
  CHECK_FALSE(scores.of(7).accuracy());
  scores.begin(second);  // after a resume: goes on
  CHECK(scores.points() == 3);
  // a new attempt has no points before its first trial
  const core::BlockStart again{1, 1, "main", "", false};
  scores.begin(again);
  CHECK(scores.points() == 0);
  scores.add(again, right);
  CHECK(scores.points() == 2);
  CHECK(scores.of(2).trials == 0);
  // so do blocks as they were stored, in the order in which they ran
  session::Scores stored;
  stored.add(
      {{practice, {right}}, {first, {right}}, {second, {right, right}}, {{0, 1, "practice", "", true}, {}}});
  CHECK(stored.points() == 0);
  CHECK(stored.accuracies().empty());
}

TEST_CASE("missed, early and unsure answers count as not right, in a block's score as for its goal",
          "[session]") {
  session::Scores scores;
  const core::BlockStart main{0, 0, "main", "", false};
  scores.begin(main);
  core::TrialRow row;
  row.correct_response = "a";
  for (const auto outcome : {core::Outcome::timeout, core::Outcome::anticipation, core::Outcome::answered}) {
    row.outcome = outcome;  // the answer is "unsure": neither right nor wrong
    scores.add(main, row);
  }
  row.given.correct = true;
  scores.add(main, row);
  CHECK(scores.of(0).trials == 4);
  CHECK(scores.of(0).accuracy() == 0.25);
}

namespace {

std::string unforced_text() {
  return R"(format = "friction-protocol/1"
[protocol]
id = "unforced"
version = "1.0.0"
title = "Unforced"
languages = ["en"]
[random]
seed = 3
[[factor]]
name = "offset_mm"
range = [0.0, 40.0]
[scene.one]
boundary_mm = 150.0
edge = "p50"
displacement_um = 1.0
[scene.two]
base = "one"
boundary_mm = "150 + offset_mm"
[task]
kind = "2ifc"
intervals = ["one", "two"]
duration_s = 0.6
gap_s = 0.3
device = "touch"
question = { en = "Where was it longer?" }
choices = [{ id = "first", label = { en = "First" } }, { id = "second", label = { en = "Second" } }]
unsure = { en = "I don't know" }
correct = "two"
[payoff]
right = 4
wrong = -4
unsure = 1
[timing]
response_zero = "interval_off"
deadline_s = 20.0
iti_s = 0.5
[[procedure]]
name = "staircase"
kind = "weighted-up-down"
target = 0.75
level = "offset_mm"
start = 20.0
min = 1.0
max = 40.0
step_down = [2.0]
stop = { trials = 60 }
[[block]]
name = "main"
procedures = ["staircase"]
feedback = "block"
)";
}

}  // namespace

TEST_CASE("people who do not want to guess may say so, and the level steps as after a guess on average",
          "[session]") {
  const Station station(unforced_text());
  Screen screen;
  const auto summary = run(station.setup("sim:threshold=9,lapse=0,unsure=0.8"), screen);
  CHECK(summary.status == core::SessionStatus::completed);
  const auto stored = store::read_session(station.database, summary.session_id);
  std::map<std::string, int> answers;
  const auto& rows = stored.blocks.front().trials;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    REQUIRE(row.given.response);
    ++answers[*row.given.response];
    CHECK(row.outcome == core::Outcome::answered);
    CHECK(row.given.correct.has_value() == (row.given.response != "unsure"));
    CHECK(row.given.points == (!row.given.correct ? 1 : *row.given.correct ? 4 : -4));
    const double step = !row.given.correct ? 2 : *row.given.correct ? -2 : 6;
    if (i + 1 < rows.size()) CHECK(*rows[i + 1].level == std::clamp(*row.level + step, 2.0, 40.0));
  }
  const auto right =
      std::count_if(rows.begin(), rows.end(), [](const auto& row) { return row.given.correct == true; });
  const auto over = screen.titled("End of this part");
  REQUIRE(over.size() == 1);
  CHECK(over.front().text.find(fmt::format(
            "Correct: {:.0f}", 100.0 * static_cast<double>(right) / static_cast<double>(rows.size()))) == 0);
  CHECK(answers["unsure"] > 5);
  CHECK(answers["first"] > 5);
  CHECK(answers["second"] > 5);
  for (const auto& page : screen.pages)
    if (page.kind == session::PageKind::response) {
      REQUIRE(page.answers.size() == 3);
      CHECK(page.answers[2].id == "unsure");
      CHECK(page.answers[2].label == "I don't know");
    }
}

TEST_CASE("a session with unsure answers goes on after a crash as if nothing had happened", "[session]") {
  constexpr const char* kObserver = "sim:threshold=9,lapse=0,unsure=0.8";
  const Station whole(unforced_text()), station(unforced_text());
  Screen screen, rest;
  const auto expected = store::read_session(whole.database, run(whole.setup(kObserver), screen).session_id);
  const auto found =
      store::read_session(station.database, run_cut(station, kObserver, 200, "resume", rest).session_id);
  REQUIRE(found.blocks.front().trials.size() == expected.blocks.front().trials.size());
  for (std::size_t i = 0; i < found.blocks.front().trials.size(); ++i) {
    CHECK(found.blocks.front().trials[i].level == expected.blocks.front().trials[i].level);
    CHECK(found.blocks.front().trials[i].given.response == expected.blocks.front().trials[i].given.response);
  }
}

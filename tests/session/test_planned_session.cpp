// Tests studies with sessions on several days: which session comes next, when it is refused, and what is
// stored.
#include <time.h>

#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "station/core/problem.hpp"
#include "station/core/read_file.hpp"
#include "station/core/usage_error.hpp"
#include "station/procedure/procedure.hpp"
#include "station/session/planned_session.hpp"
#include "station/session/prepare.hpp"
#include "station/session/resume.hpp"
#include "station/store/read.hpp"
#include "station/view/report_data.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/quick_rig.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using core::SessionStatus;

namespace {

const std::string kRoot = TURNPOINT_SOURCE_DIR;

session::RunRequest training_for(const std::string& participant, const std::string& database) {
  auto request = simulated_run(kRoot + "/protocols/friction-training.toml", database, 7);
  request.participant = participant;
  return request;
}

session::Summary run(const session::RunRequest& request) {
  session::Inputs inputs;
  return session::run(session::prepare(request), nullptr, inputs);
}

/// A setup for a pilot session of the training, without a database.
session::Setup training(int min_days, protocol::Unfinished incomplete = protocol::Unfinished::repeat) {
  session::Setup setup;
  setup.protocol = protocol::load(kRoot + "/protocols/friction-training.toml");
  setup.protocol.sessions->min_days = min_days;
  setup.protocol.sessions->incomplete = incomplete;
  setup.participant = "P01";
  return setup;
}

store::SessionRecord on_day(const std::string& date, int number,
                            SessionStatus status = SessionStatus::completed,
                            core::RunMode mode = core::RunMode::pilot) {
  store::SessionRecord session;
  session.start.started_local = date + "T23:59:59+0100";
  session.start.planned_session = number;
  session.start.run_mode = mode;
  session.status = status;
  session.trials = 10;
  return session;
}

std::vector<std::string> blocks_of(const std::string& database, const std::string& id) {
  std::vector<std::string> names;
  for (const auto& block : store::read_session(database, id).blocks) names.push_back(block.start.name);
  return names;
}

}  // namespace

TEST_CASE("the next session is the first one that was not completed", "[session]") {
  const auto setup = training(0);
  const auto next = [&](const std::vector<store::SessionRecord>& earlier) {
    return next_session(setup, earlier, "2026-11-24").number;
  };
  CHECK(next({}) == 1);
  CHECK(next({on_day("2026-11-01", 1)}) == 2);
  CHECK(next({on_day("2026-11-01", 1, SessionStatus::interrupted)}) == 1);
  CHECK(next({on_day("2026-11-01", 1), on_day("2026-11-02", 2, SessionStatus::stopped)}) == 2);
  CHECK(next({on_day("2026-11-01", 2)}) == 1);  // the first session was left out, so it comes next
  CHECK(next({on_day("2026-11-01", 1, SessionStatus::completed, core::RunMode::simulated)}) == 1);
  const auto over = next_session(
      setup, {on_day("2026-11-01", 1), on_day("2026-11-02", 2), on_day("2026-11-03", 3)}, "2026-11-24");
  CHECK(core::say(over.problem, "en") == "participant P01 has completed all 3 sessions of friction-training");

  const auto counted = training(0, protocol::Unfinished::count);
  CHECK(next_session(counted, {on_day("2026-11-01", 1, SessionStatus::interrupted)}, "2026-11-24").number ==
        2);
  auto empty = on_day("2026-11-01", 1, SessionStatus::abandoned);
  empty.trials = 0;
  CHECK(next_session(counted, {empty}, "2026-11-24").number == 1);
}

TEST_CASE("a session that comes too early is refused with the date from which it is allowed", "[session]") {
  auto setup = training(2);
  const std::vector<store::SessionRecord> earlier{on_day("2024-02-27", 1)};  // 2024 is a leap year
  for (const auto* day : {"2024-02-27", "2024-02-28"}) {
    const auto refused = next_session(setup, earlier, day);
    CHECK(refused.number == 2);
    CHECK(core::say(refused.problem, "en") ==
          "participant P01 had session 1 on 2024-02-27, and the protocol asks for at least 2 days between "
          "sessions: "
          "session 2 is allowed from 2024-02-29");
    CHECK(core::say(refused.allowed, "en").find("--early") != std::string::npos);
    REQUIRE(refused.too_early);
    CHECK(refused.too_early->participant == setup.participant);
    CHECK(refused.too_early->number == 2);
    CHECK(refused.too_early->allowed_from == "2024-02-29");
    CHECK(refused.too_early->last_number == 1);
    CHECK(refused.too_early->last_day == "2024-02-27");
    CHECK(refused.too_early->min_days == 2);
  }
  CHECK(next_session(setup, earlier, "2024-02-29").problem.empty());
  CHECK(core::say(next_session(setup, {on_day("2023-12-31", 1)}, "2024-01-01").problem, "en")
            .find("2024-01-02") != std::string::npos);
  CHECK(next_session(setup, {on_day("2024-02-20", 1), on_day("2024-02-27", 2)}, "2024-02-28").number == 3);
  CHECK_FALSE(
      next_session(setup, {on_day("2024-02-27", 2), on_day("2024-02-20", 1)}, "2024-02-28").problem.empty());

  setup.early = "leaves the country";
  const auto overruled = next_session(setup, earlier, "2024-02-28");
  CHECK(overruled.problem.empty());
  CHECK_FALSE(overruled.too_early);
  CHECK(overruled.overruled.find("allowed from 2024-02-29") != std::string::npos);
  CHECK(next_session(setup, earlier, "2024-02-29").overruled.empty());

  setup.early.clear();
  setup.run_mode = core::RunMode::simulated;
  const auto simulated = on_day("2024-02-27", 1, SessionStatus::completed, core::RunMode::simulated);
  CHECK(next_session(setup, {simulated}, "2024-02-27").problem.empty());
  CHECK(next_session(setup, {simulated}, "2024-02-27").number == 2);
}

TEST_CASE("the operator can choose another session", "[session]") {
  auto setup = training(0);
  setup.planned_session = 3;
  CHECK(next_session(setup, {}, "2026-11-24").number == 3);
  setup.planned_session = 4;
  CHECK(core::say(next_session(setup, {}, "2026-11-24").problem, "en") ==
        "--planned-session 4: the protocol plans 3 sessions");
  CHECK_FALSE(next_session(setup, {}, "2026-11-24").too_early);
  setup.planned_session = 1;
  setup.protocol.sessions.reset();
  CHECK(core::say(next_session(setup, {}, "2026-11-24").problem, "en") ==
        "the protocol friction-training plans no sessions");
}

TEST_CASE("two participants of two groups go through their sessions, and group and number are stored",
          "[session]") {
  TemporaryFolder folder;
  const auto db = folder / "lab.sqlite";
  using Names = std::vector<std::string>;
  for (int number = 1; number <= 3; ++number)
    for (const std::string code : {"A", "B"}) {
      const auto summary = run(training_for(code, db));
      CHECK(summary.status == SessionStatus::completed);
      const auto stored = store::read_session(db, summary.session_id).session;
      CHECK(stored.start.planned_session == number);
      const std::string group = code == "A" ? "feedback" : "none";
      CHECK(stored.start.group == group);
      const auto training = code == "A" ? "training-with-feedback" : "training-without-feedback";
      CHECK(blocks_of(db, summary.session_id) == (number == 1   ? Names{"practice", "before", training}
                                                  : number == 2 ? Names{training}
                                                                : Names{training, "after"}));
      for (const auto& block : store::read_session(db, summary.session_id).blocks)
        for (const auto& trial : block.trials)
          for (const auto& [name, value] : trial.factors)
            if (name == "training") CHECK(std::get<std::string>(value) == group);
    }
  CHECK_THROWS_AS(run(training_for("A", db)), core::BadInput);
  // A participant whose code is typed later is refused when the session begins, before anything is stored.
  auto setup = session::prepare([&] {
    auto request = training_for(session::kCodeToCome, db);
    return request;
  }());
  setup.participant = "A";
  session::Inputs inputs;
  CHECK_THROWS_AS(session::run(setup, nullptr, inputs), core::UsageError);
  CHECK(store::list_sessions(db).size() == 6);
}

TEST_CASE("a live session on the same day is refused, unless the operator gives a reason, which is stored",
          "[session]") {
  const TemporaryFolder folder;
  auto setup = live_room::live_setup(folder / "a.sqlite");
  setup.protocol.sessions = protocol::SessionPlan{2, 1, protocol::Unfinished::repeat, {}};
  const auto meet = [&] {
    live_room::Room room;
    room.reacts = [&room](const session::Page& page) { room.cooperate(page); };
    return session::run(setup, &room, room.inputs, room.devices());
  };
  CHECK(meet().status == SessionStatus::completed);
  auto now = ::time(nullptr);
  tm tomorrow{};
  ::localtime_r(&now, &tomorrow);
  ++tomorrow.tm_mday;
  now = ::mktime(&tomorrow);
  char date[20];
  ::strftime(date, sizeof date, "%Y-%m-%d", &tomorrow);
  CHECK_THROWS_WITH(meet(),
                    Catch::Matchers::ContainsSubstring(std::string("session 2 is allowed from ") + date));
  CHECK(store::list_sessions(setup.database).size() == 1);  // nothing was stored

  setup.early = "only in town today";
  const auto second = store::read_session(setup.database, meet().session_id).session;
  CHECK(second.start.planned_session == 2);
  REQUIRE(second.annotations.size() == 1);
  CHECK(second.annotations.front().starts_with(
      "begun early (only in town today): participant P01 had session 1"));
}

namespace {

/// Writes a study of two sessions with 14 trials of one staircase, which continues, and returns its path.
std::string continuing_study(const TemporaryFolder& folder, const std::string& version = "1.0.0",
                             const std::string& more = "continues = true") {
  auto source = core::read_file(kRoot + "/protocols/friction-training.toml");
  source.resize(source.find("[[procedure]]"));
  source = replaced(source, "version = \"1.0.0\"", "version = \"" + version + "\"");
  source = replaced(source, "count = 3", "count = 2");
  source += R"(
[[procedure]]
name = "stairs"
kind = "up-down"
with = { phase = "before" }
level = "contrast_dB"
start = -6.0
min = -30.0
max = -3.0
step = [3.0, 1.5]
n_down = 2
stop = { trials = 1000 }
)" + more + R"(

[[block]]
name = "main"
procedures = ["stairs"]
trials = 14
)";
  std::ofstream(folder / "study.toml") << source;
  return folder / "study.toml";
}

/// Adds the trials of a session to those before, and checks that one staircase presents them all.
void add_and_compare(const std::string& database, const session::Summary& summary, const std::string& path,
                     std::vector<core::TrialRow>& rows) {
  for (const auto& block : store::read_session(database, summary.session_id).blocks)
    rows.insert(rows.end(), block.trials.begin(), block.trials.end());
  const auto protocol = protocol::load(path);
  const auto stairs = procedure::make_procedure(protocol.procedures.front(), {}, {});
  for (const auto& row : rows) {
    if (row.type != core::TrialType::experimental || row.outcome == core::Outcome::aborted) continue;
    REQUIRE(stairs->next()->level == row.level.value());
    stairs->record(row.outcome != core::Outcome::answered ? procedure::Answer::none
                   : row.given.correct.value_or(false)    ? procedure::Answer::one
                                                          : procedure::Answer::zero);
  }
}

}  // namespace

TEST_CASE("a procedure that continues goes on where the participant's last session ended",
          "[session][continuation]") {
  const TemporaryFolder folder;
  auto request = training_for("P01", folder / "a.sqlite");
  request.protocol = continuing_study(folder);
  std::vector<core::TrialRow> rows;
  const auto first = run(request);
  add_and_compare(request.database, first, request.protocol, rows);
  const auto end_of_first = rows.size();

  SECTION("the second session continues, also after an interruption; another person begins anew") {
    struct Cut : session::Monitor {
      int left = 5;
      void trial_ended(const trial::TrialSpec&, const core::TrialRow&) override {
        if (--left == 0) throw std::runtime_error("cut");
      }
    } cut;
    session::Inputs inputs;
    CHECK_THROWS(session::run(session::prepare(request), nullptr, inputs, &cut));
    std::ostringstream messages;
    session::ResumeRequest again;
    again.database = request.database;
    const auto resumed = session::prepare_resume(again, messages);
    REQUIRE(resumed);
    const auto second = session::run(*resumed, nullptr, inputs);
    CHECK(second.status == SessionStatus::completed);
    add_and_compare(request.database, second, request.protocol, rows);
    CHECK(rows.size() == 2 * end_of_first);
    CHECK(rows[end_of_first].level != rows.front().level);
    const auto report = view::report_data(request.database, second.session_id).front();
    REQUIRE(report.estimates.size() == 1);
    REQUIRE(second.estimates.size() == 1);
    CHECK(report.estimates[0].mean == second.estimates[0].mean);
    CHECK(report.estimates[0].basis == second.estimates[0].basis);

    request.participant = "P02";
    CHECK(store::read_session(request.database, run(request).session_id).blocks.at(0).trials.at(0).level ==
          -6);
  }
  SECTION("the same study without the key begins anew") {
    request.protocol = continuing_study(folder, "1.0.0", "");
    CHECK(store::read_session(request.database, run(request).session_id).blocks.at(0).trials.at(0).level ==
          -6);
  }
  SECTION("another version of the protocol is refused, and nothing is stored") {
    request.protocol = continuing_study(folder, "1.1.0");
    CHECK_THROWS_WITH(
        session::prepare(request),
        Catch::Matchers::ContainsSubstring("participant P01 had session 1 with version 1.0.0") &&
            Catch::Matchers::ContainsSubstring("this file is version 1.1.0"));
    CHECK(store::list_sessions(request.database).size() == 1);
  }
  SECTION("a changed procedure of the same version is refused, and nothing is stored") {
    auto source = core::read_file(request.protocol);
    std::ofstream(request.protocol) << replaced(source, "start = -6.0", "start = -7.0");
    CHECK_THROWS_WITH(run(request),
                      Catch::Matchers::ContainsSubstring("would present level -7, but level -6 is stored"));
    CHECK(store::list_sessions(request.database).size() == 1);
  }
}

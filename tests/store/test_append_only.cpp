#include "station/store/read.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

TEST_CASE("rows of trials, tones and events cannot be changed or deleted", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 3);
  auto raw = sample::raw(db);
  const auto* sql =
      GENERATE("UPDATE trial SET response = 'first'", "DELETE FROM trial WHERE trial_index = 2",
               "UPDATE tone SET frequency_Hz = 1", "DELETE FROM tone", "UPDATE signal SET points = 1",
               "DELETE FROM signal", "UPDATE event SET kind = 'x'", "DELETE FROM event",
               "UPDATE session SET seed = 1", "UPDATE session SET participant = 'P02'");
  INFO(sql);
  const auto [fault, message] = sample::failure([&] { raw.execute(sql); });
  CHECK(fault == ErrorKind::refused);
  CHECK((sample::contains(message, "append-only") || sample::contains(message, "never changed")));
  CHECK(raw.integer("SELECT count(*) FROM trial WHERE trial_index = 2 OR response = 'second'") == 2);
}

TEST_CASE("negative control: without its trigger a trial can be changed", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 3);
  auto raw = sample::raw(db);
  raw.execute("DROP TRIGGER trial_is_never_changed; UPDATE trial SET xruns = 7");
  CHECK(raw.integer("SELECT sum(xruns) FROM trial") == 21);
}

TEST_CASE("a trial that was not answered has no answer, no score and no response time", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto log = SessionLog::begin(db, sample::start(), sample::segment());
  log.begin_block(sample::block());
  const auto outcome = GENERATE(Outcome::timeout, Outcome::anticipation, Outcome::aborted, Outcome::fault);
  auto trial = sample::timeout(0);
  trial.outcome = outcome;
  SECTION("an answer is refused") { trial.given.response = "first"; }
  SECTION("a response time is refused") { trial.timing.response_time_s = 0.3; }
  SECTION("a movement time is refused") { trial.timing.movement_time_s = 0.1; }
  SECTION("a score is refused") { trial.given.correct = true; }
  SECTION("a confidence is refused") { trial.given.confidence = 1, trial.given.confidence_time_s = 0.5; }
  const auto [fault, message] = sample::failure([&] { log.append(trial); });
  CHECK(fault == ErrorKind::refused);
  CHECK(sample::contains(message, "CHECK constraint failed"));
  CHECK(sample::raw(db).integer("SELECT count(*) FROM trial") == 0);
}

TEST_CASE("negative control: each outcome without an answer is accepted if the trial has no answer",
          "[store]") {
  TemporaryFolder folder;
  auto log = SessionLog::begin(folder / "a.sqlite", sample::start(), sample::segment());
  log.begin_block(sample::block());
  int index = 0;
  for (const auto outcome : {Outcome::timeout, Outcome::anticipation, Outcome::aborted, Outcome::fault}) {
    auto trial = sample::timeout(index++);
    trial.outcome = outcome;
    if (outcome == Outcome::aborted || outcome == Outcome::fault) trial.given.points.reset();
    log.append(trial);
  }
  CHECK(log.session().trials == 4);
}

TEST_CASE("a void trial is worth no points", "[store]") {
  TemporaryFolder folder;
  auto log = SessionLog::begin(folder / "a.sqlite", sample::start(), sample::segment());
  log.begin_block(sample::block());
  auto trial = sample::failed(0);
  trial.outcome = GENERATE(Outcome::aborted, Outcome::fault);
  trial.given.points = 1;
  const auto [fault, message] = sample::failure([&] { log.append(trial); });
  CHECK(fault == ErrorKind::refused);
  CHECK(sample::contains(message, "points IS NULL"));
}

TEST_CASE("an answered trial must have a response time of 0 or more and a score that agrees with the answer",
          "[store]") {
  TemporaryFolder folder;
  auto log = SessionLog::begin(folder / "a.sqlite", sample::start(), sample::segment());
  log.begin_block(sample::block());
  auto trial = sample::answered(1);
  SECTION("no response time") { trial.timing.response_time_s.reset(); }
  SECTION("a negative response time") { trial.timing.response_time_s = -0.016; }
  SECTION("a score that contradicts the answer") { trial.given.correct = !*trial.given.correct; }
  SECTION("a score where nothing is right") { trial.correct_response.reset(); }
  CHECK(sample::failure([&] { log.append(trial); }).first == ErrorKind::refused);
}

TEST_CASE("a trial index can occur only once in a session", "[store]") {
  TemporaryFolder folder;
  auto log = SessionLog::begin(folder / "a.sqlite", sample::start(), sample::segment());
  log.begin_block(sample::block());
  log.append(sample::answered(0));
  CHECK(sample::failure([&] { log.append(sample::answered(0)); }).first == ErrorKind::refused);
  log.append(sample::answered(1));
  CHECK(log.session().trials == 2);
}

TEST_CASE("tables are STRICT: a word is refused in a column of numbers", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 1);
  auto raw = sample::raw(db);
  CHECK(raw.integer(
            "SELECT count(*) FROM pragma_table_list WHERE schema = 'main' AND type = 'table' AND strict = 0"
            " AND name NOT LIKE 'sqlite_%'") == 0);
  // `trial` is an ordinary table with row ids
  CHECK(raw.integer("SELECT wr FROM pragma_table_list WHERE name = 'trial'") == 0);
  CHECK(sample::failure([&] {
          raw.execute("INSERT INTO event SELECT session_id, 99, 1, 'soon', 'touch', '', NULL FROM session");
        }).first == ErrorKind::refused);
}

#include "station/store/read.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

TEST_CASE("the database contains exactly what the session log was given", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 6);
  const auto stored = read_session(db, id);
  CHECK(stored.session.status == SessionStatus::completed);
  CHECK(stored.session.trials == 6);
  CHECK(stored.session.segments == 1);
  CHECK(stored.session.session_index == 1);
  CHECK(stored.session.sequence_index == 0);
  CHECK(stored.session.start.seed == 20240229);
  CHECK(stored.session.start.protocol_text == sample::start().protocol_text);
  CHECK(stored.session.start.factor_columns == sample::start().factor_columns);
  REQUIRE(stored.blocks.size() == 1);
  REQUIRE(stored.blocks[0].trials.size() == 6);
  const auto& trial = stored.blocks[0].trials[1];
  const auto expected = sample::answered(1);
  CHECK(trial.level == expected.level);
  CHECK(trial.factors == expected.factors);  // one factor is 0.1 + 0.2, which must be kept to the last bit
  CHECK(trial.given.response == expected.given.response);
  CHECK(trial.given.correct == expected.given.correct);
  CHECK(trial.timing.response_time_s == expected.timing.response_time_s);
  CHECK(trial.learned.state_hash == expected.learned.state_hash);
  CHECK(trial.timing.onset_ns == expected.timing.onset_ns);
  REQUIRE(trial.tones.size() == 4);
  CHECK(trial.tones[3].frequency_Hz == expected.tones[3].frequency_Hz);
  CHECK(trial.tones[3].interval_index == 1);
  CHECK(stored.blocks[0].trials[4].outcome == Outcome::timeout);
  CHECK(stored.events.size() == 12);
  CHECK(stored.events[0].kind == "presented");
  CHECK(stored.events[1].kind == "answer");
}

TEST_CASE("every call's data are stored when it returns, and another connection can read them at once",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto log = SessionLog::begin(db, sample::start(), sample::segment());
  log.begin_block(sample::block());
  auto reader = sample::raw(db);
  CHECK(reader.integer("PRAGMA synchronous") == 2);
  for (int i = 0; i < 5; ++i) {
    log.presented(i, 1);
    CHECK(reader.integer("SELECT count(*) FROM event WHERE kind = 'presented'") == i + 1);
    log.append(sample::answered(i));
    CHECK(reader.integer("SELECT count(*) FROM trial") == i + 1);
  }
  CHECK(reader.text("PRAGMA journal_mode") == "wal");
}

TEST_CASE("events wait for the next commit and keep their order", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto log = SessionLog::begin(db, sample::start(), sample::segment());
  log.begin_block(sample::block());
  auto reader = sample::raw(db);
  log.event({10, "touch", "1", std::nullopt});
  log.event({20, "touch", "2", 0});
  CHECK(reader.integer("SELECT count(*) FROM event") == 0);
  log.presented(0, 30);
  CHECK(reader.text("SELECT group_concat(kind || time_ns) FROM event") == "touch10,touch20,presented30");
  log.event({40, "answer", "0", 0});
  log.finish(SessionStatus::stopped, "asked to");
  CHECK(reader.integer("SELECT max(event_index) FROM event") == 3);
  CHECK(reader.text("SELECT status_reason FROM session") == "asked to");
}

TEST_CASE("participants are numbered within each protocol, and sessions within each participant", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto begin = [&](const std::string& participant, const std::string& protocol) {
    auto start = sample::start(participant);
    start.protocol_id = protocol;
    const auto log = SessionLog::begin(db, start, sample::segment());
    return std::pair(log.session().sequence_index, log.session().session_index);
  };
  CHECK(begin("P01", "a") == std::pair(0, 1));
  CHECK(begin("P02", "a") == std::pair(1, 1));
  CHECK(begin("P01", "a") == std::pair(0, 2));
  CHECK(begin("P02", "b") == std::pair(0, 1));
  CHECK(begin("P03", "a") == std::pair(2, 1));
}

TEST_CASE("the text of a protocol or rig is stored once, however many sessions use it", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 1);
  sample::session(db, 1);
  auto changed = sample::start();
  changed.protocol_text += "# a comment\n";
  sample::session(db, 1, changed);
  auto raw = sample::raw(db);
  CHECK(raw.integer("SELECT count(*) FROM session") == 3);
  CHECK(raw.integer("SELECT count(*) FROM protocol") == 2);
  CHECK(raw.integer("SELECT count(*) FROM rig") == 1);
}

TEST_CASE(
    "if its process ended, a session without trials is closed as abandoned, and one with trials as "
    "interrupted",
    "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  std::string empty, half;
  {
    auto log = SessionLog::begin(db, sample::start(), sample::segment());
    empty = log.session().session_id;
  }
  {
    auto log = SessionLog::begin(db, sample::start(), sample::segment());
    log.begin_block(sample::block());
    log.append(sample::answered(0));
    half = log.session().session_id;
  }
  sample::session(db, 1);
  CHECK(read_session(db, empty).session.status == SessionStatus::abandoned);
  CHECK(read_session(db, half).session.status == SessionStatus::interrupted);
}

TEST_CASE("a trial outside a block is refused", "[store]") {
  TemporaryFolder folder;
  auto log = SessionLog::begin(folder / "a.sqlite", sample::start(), sample::segment());
  const auto [fault, message] = sample::failure([&] { log.append(sample::answered(0)); });
  CHECK(fault == ErrorKind::refused);
  CHECK(sample::contains(message, "begin_block"));
}

TEST_CASE("a number that is not finite never becomes a missing value", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto log = SessionLog::begin(db, sample::start(), sample::segment());
  log.begin_block(sample::block());
  auto trial = sample::answered(0);
  trial.learned.threshold_sd = std::numeric_limits<double>::quiet_NaN();
  CHECK(sample::failure([&] { log.append(trial); }).first == ErrorKind::refused);
  CHECK(sample::raw(db).integer("SELECT count(*) FROM trial") == 0);
  trial.learned.threshold_sd = std::nullopt;
  log.append(trial);
  CHECK(sample::raw(db).integer("SELECT count(*) FROM trial WHERE threshold_sd IS NULL") == 1);
}

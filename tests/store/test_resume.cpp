#include "station/store/read.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

/// Simulates a process that stores `trials` trials of block 0, presents one more, and ends abruptly. Returns
/// the session's id.
std::string broken_session(const std::string& db, int trials, const SessionStart& start = sample::start()) {
  auto log = SessionLog::begin(db, start, sample::segment());
  log.begin_block(sample::block());
  for (int i = 0; i < trials; ++i) log.append(sample::answered(i));
  log.presented(trials, 77);
  return log.session().session_id;
}

}  // namespace

TEST_CASE("a resumed session has all its trials, a new segment, and the open trial marked as aborted",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = broken_session(db, 4);
  {
    auto log = SessionLog::resume(db, id, sample::segment("resume"));
    CHECK(log.session().segments == 2);
    CHECK(log.session().status == SessionStatus::running);
    const auto blocks = read_session(db, id).blocks;
    REQUIRE(blocks.size() == 1);
    REQUIRE(blocks[0].trials.size() == 4);
    CHECK(blocks[0].trials[3].learned.state_hash == sample::answered(3).learned.state_hash);
    CHECK(blocks[0].trials[3].factors == sample::answered(3).factors);
    log.begin_block(sample::block());
    log.presented(4, 88);
    log.append(sample::answered(4));
    log.finish(SessionStatus::completed, "");
  }
  const auto stored = read_session(db, id);
  REQUIRE(stored.blocks.size() == 1);
  REQUIRE(stored.blocks[0].trials.size() == 5);
  CHECK(stored.blocks[0].trials[3].segment_index == 1);
  CHECK(stored.blocks[0].trials[4].segment_index == 2);
  REQUIRE(stored.segments.size() == 2);
  CHECK(stored.segments[1].reason == "resume");
  REQUIRE(stored.events.size() == 3);
  CHECK(stored.events[1].kind == "aborted");
  CHECK(stored.events[1].trial_index == 4);
  CHECK(stored.events[1].segment_index == 2);
}

TEST_CASE("a block that is started again counts as another attempt, and the rows of the first attempt stay",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = broken_session(db, 2);
  auto log = SessionLog::resume(db, id, sample::segment("resume"));
  log.begin_block(sample::block(0, 1));
  log.append(sample::answered(2));
  const auto stored = read_session(db, id);
  REQUIRE(stored.blocks.size() == 2);
  CHECK(stored.blocks[0].trials.size() == 2);
  CHECK(stored.blocks[1].start.attempt == 1);
  CHECK(stored.blocks[1].trials.size() == 1);
}

TEST_CASE("continuing a block with another name or instruction is refused", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto log = SessionLog::resume(db, broken_session(db, 2), sample::segment("resume"));
  auto other = sample::block();
  other.instruction = "accuracy";
  CHECK(sample::failure([&] { log.begin_block(other); }).first == ErrorKind::conflict);
  log.begin_block(sample::block());
}

TEST_CASE("only an interrupted session can be resumed; for any other, the error states its status",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 2);
  const auto [fault, message] =
      sample::failure([&] { SessionLog::resume(db, id, sample::segment("resume")); });
  CHECK(fault == ErrorKind::refused);
  CHECK(sample::contains(message, "is completed"));
  CHECK(sample::failure([&] { SessionLog::resume(db, "nothing", sample::segment()); }).first ==
        ErrorKind::missing);
  CHECK(sample::failure([&] { SessionLog::resume(folder / "no.sqlite", id, sample::segment()); }).first ==
        ErrorKind::missing);
}

TEST_CASE("the newest interrupted session is found with its age, and sessions without trials are ignored",
          "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 2);
  CHECK_FALSE(interrupted_session(db));
  const auto first = broken_session(db, 1);
  const auto second = broken_session(db, 3, sample::start("P02"));
  // a session without a trial cannot be resumed
  { SessionLog::begin(db, sample::start("P03"), sample::segment()); }
  const auto found = interrupted_session(db);
  REQUIRE(found);
  CHECK(found->session.session_id == second);
  CHECK(found->session.start.participant == "P02");
  CHECK(found->session.trials == 3);
  CHECK(found->age_s >= 0);
  CHECK(found->age_s < 600);
  const auto named = interrupted_session(db, first);
  REQUIRE(named);
  CHECK(named->session.trials == 1);
  CHECK_FALSE(interrupted_session(db, "another id"));
}

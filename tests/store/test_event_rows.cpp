// Tests that rows that belong to an event (answers, checks of a self-test, levels of a friction table) are
// stored with the event, survive a merge, and are covered by the checksum.
#include "station/store/merge.hpp"
#include "station/store/read.hpp"
#include "station/store/verify.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

TEST_CASE("the answers to a questionnaire are read back, merged, and covered by the checksum", "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", other = folder / "b.sqlite";
  std::string id;
  {
    auto log = SessionLog::begin(db, sample::start(), sample::segment());
    for (const auto* answer : {"left", "right"}) {
      EventRow asked{1'500'000'000, kAnswerEvent, "", std::nullopt};
      asked.answers = {{"about-you", "hand", 0, answer, 2.5}};
      log.event(asked);
      log.keep_events();
      if (answer == std::string("left"))
        log.event({1'600'000'000, kBackEvent, place_name("about-you", 0), std::nullopt});
    }
    id = log.session().session_id;
  }  // the process dies before the first trial
  const auto check = [&](const std::string& path) {
    const auto stored = read_session(path, id);
    REQUIRE(stored.events.size() == 3);
    const auto standing = standing_answers(stored.events);
    REQUIRE(standing.size() == 1);
    CHECK(standing[0]->answers == std::vector<AnswerRow>{{"about-you", "hand", 0, "right", 2.5}});
    CHECK(verify(path).good());
  };
  check(db);
  { auto continued = SessionLog::resume(db, id, sample::segment()); }
  check(db);
  auto elsewhere = sample::start("P02");
  elsewhere.station_id = "bench-b";
  sample::session(other, 1, elsewhere);
  merge(other, db);
  check(other);
  auto database = sample::raw(db);
  CHECK_THROWS(database.execute("DELETE FROM answer"));
  database.execute("DROP TRIGGER answer_is_never_changed");
  database.execute("UPDATE answer SET answer = 'both' WHERE answer = 'right'");
  CHECK_FALSE(verify(db).good());
}

TEST_CASE(
    "self-tests, friction tables and separate programs are read back, merged, and covered by the checksum",
    "[store]") {
  TemporaryFolder folder;
  const auto db = folder / "a.sqlite", other = folder / "b.sqlite";
  const ProgramRow program{"procedure", "stairs",       "one-up-two-down",
                           "1.2",       "/p/stairs.py", std::string(64, 'c')};
  std::string id;
  {
    auto log = SessionLog::begin(db, sample::start(), sample::segment());
    EventRow tested{1'500'000'000, "self_test", "passed", std::nullopt};
    tested.checks = {{"gate", Verdict::passed, 110.5, 250, "ms", "it shut"},
                     {"cells", Verdict::not_possible, {}, {}, "", "the rig has none"}};
    log.event({1'400'000'000, "touch", "0.1 0.2", std::nullopt});
    log.event(tested);
    EventRow measured{1'600'000'000, "friction_table", "used", std::nullopt};
    measured.friction_levels = {{0.5, 6, 0.71, 0.7, 0.03, 0.63, 0.78}, {1.5, 5, 0.2, 0.21, 0.01, 0.18, 0.24}};
    log.event(measured);
    EventRow started{1'700'000'000, kProgramEvent, "stairs", std::nullopt};
    started.programs = {program};
    log.event(started);
    log.begin_block(sample::block());
    log.append(sample::answered(0));
    EventRow estimated{1'800'000'000, kEstimatesEvent, "stairs", std::nullopt};
    estimated.estimates = {{0, 1, "stairs", "threshold", -7.25, 1.5, "8 reversals"},
                           {0, 1, "stairs", "width", 0.5, {}, ""}};
    log.event(estimated);
    log.finish(SessionStatus::completed, "");
    id = log.session().session_id;
  }
  const auto check = [&](const std::string& path) {
    const auto events = read_session(path, id).events;
    REQUIRE(events.size() == 5);
    CHECK(events[3].programs == std::vector{program});
    CHECK(events[3].estimates.empty());
    REQUIRE(events[4].estimates.size() == 2);
    CHECK(events[4].estimates[0].attempt == 1);
    CHECK(events[4].estimates[0].mean == -7.25);
    CHECK(events[4].estimates[0].sd == 1.5);
    CHECK(events[4].estimates[0].basis == "8 reversals");
    CHECK(events[4].estimates[1].parameter == "width");
    CHECK_FALSE(events[4].estimates[1].sd);
    CHECK(events[0].checks.empty());
    CHECK(events[1].friction_levels.empty());
    REQUIRE(events[2].friction_levels.size() == 2);
    CHECK(events[2].friction_levels[1].displacement_um == 1.5);
    CHECK(events[2].friction_levels[1].trials == 5);
    CHECK(events[2].friction_levels[1].high == 0.24);
    REQUIRE(events[1].checks.size() == 2);
    CHECK(events[1].checks[0].limit == 250.0);
    CHECK(events[1].checks[1].verdict == Verdict::not_possible);
    CHECK_FALSE(events[1].checks[1].value);
    CHECK(verify(path).good());
  };
  check(db);
  auto elsewhere = sample::start("P02");
  elsewhere.station_id = "bench-b";
  sample::session(other, 1, elsewhere);
  merge(other, db);
  check(other);
  auto database = sample::raw(db);
  CHECK_THROWS(database.execute("DELETE FROM self_test"));
  CHECK_THROWS(database.execute("DELETE FROM friction_level"));
  CHECK_THROWS(database.execute("DELETE FROM program"));
  CHECK_THROWS(database.execute("UPDATE estimate SET mean = 1"));
  SECTION("an edited check") {
    database.execute("DROP TRIGGER self_test_is_never_changed");
    database.execute("UPDATE self_test SET verdict = 'failed' WHERE name = 'gate'");
    CHECK_FALSE(verify(db).good());
  }
  SECTION("an edited program") {
    database.execute("DROP TRIGGER program_is_never_changed");
    database.execute("UPDATE program SET version = '1.3'");
    CHECK_FALSE(verify(db).good());
  }
  SECTION("an edited estimate") {
    database.execute("DROP TRIGGER estimate_is_never_changed");
    database.execute("UPDATE estimate SET mean = -7 WHERE estimate_index = 0");
    CHECK_FALSE(verify(db).good());
  }
  SECTION("an edited friction table") {
    database.execute("DROP TRIGGER friction_level_is_never_changed");
    database.execute("UPDATE friction_level SET relative_friction = 0.22 WHERE level_index = 1");
    CHECK_FALSE(verify(db).good());
  }
}

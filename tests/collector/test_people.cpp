#include <filesystem>
#include <set>

#include "station/collector/fetch.hpp"
#include "station/collector/push.hpp"
#include "station/store/merge.hpp"
#include "station/store/people.hpp"
#include "station/store/read.hpp"
#include "station/store/session_log.hpp"
#include "station/store/station.hpp"
#include "station/store/withdraw.hpp"
#include "tests/collector/exported.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

store::SessionStart at_station(const std::string& station, const std::string& participant) {
  auto start = sample::start(participant);
  start.station_id = station;
  return start;
}

std::int64_t joins_on(const PostgresServer& postgres) {
  return postgres.admin().query("SELECT count(*) FROM turnpoint.same_person").integer(0, 0);
}

}  // namespace

TEST_CASE("codes that a station has joined are one person on the server, until it undoes that",
          "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite", merged = folder / "merged.sqlite", b = folder / "b.sqlite";
  for (const auto* code : {"P01", "P07"}) sample::session(db, 3, sample::start(code));
  sample::session(b, 3, at_station("bench-b", "P01"));
  const auto push = [&](const std::string& path, const std::string& role) {
    return collector::push({path, postgres.as(role), "", "", {}, {}});
  };
  const auto same_exports = [&](const std::string& name) {
    const collector::ReadableDatabase fetched(postgres.address("reader"));
    const auto from_server = exported(fetched.path(), folder / (name + "-server"));
    return from_server == exported(merged, folder / (name + "-file"));
  };
  store::join(db, "P07", "P01");
  push(db, "station_a");
  push(b, "station_b");
  CHECK(joins_on(postgres) == 1);
  store::merge(merged, db);
  store::merge(merged, b);
  CHECK(same_exports("joined"));
  const auto people = [&] {
    const collector::ReadableDatabase fetched(postgres.address("reader"));
    std::set<std::string> names;
    for (const auto& session : store::list_sessions(fetched.path())) names.insert(session.person);
    return names;
  };
  // the only remaining P01 is the participant of station bench-b
  CHECK(people() == std::set<std::string>{"P07", "P01"});

  // A station may not join codes of another station, so the server ignores these rows. An administrator may
  // join them.
  sample::raw(b).execute("INSERT INTO same_person VALUES ('bench-a', 'P07', 'bench-b', 'P01', 1)");
  sample::raw(b).execute("INSERT INTO same_person VALUES ('bench-a', 'P07', 'bench-a', 'P08', 1)");
  push(b, "station_b");
  CHECK(joins_on(postgres) == 1);
  auto server = postgres.admin();
  CHECK_THROWS_AS(server.query("SELECT turnpoint.join('bench-a', 'P01', 'bench-a', 'P07')"),
                  collector::ServerError);
  CHECK_THROWS_AS(server.query("SELECT turnpoint.join('bench-a', 'P99', 'bench-b', 'P01')"),
                  collector::ServerError);
  collector::Connection station(postgres.as("station_a"));
  CHECK_THROWS_AS(station.query("SELECT turnpoint.join('bench-a', 'P07', 'bench-b', 'P01')"),
                  collector::ServerError);
  server.query("SELECT turnpoint.join('bench-a', 'P07', 'bench-b', 'P01')");
  store::join(merged, "P07@bench-a", "P01@bench-b");
  CHECK(same_exports("both"));
  CHECK(people() == std::set<std::string>{"P07"});

  // The station undoes its own join. The administrator's join stays.
  store::join(db, "P07", "P01", store::Relation::two_people);
  push(db, "station_a");
  CHECK(joins_on(postgres) == 1);
  CHECK(people() == std::set<std::string>{"P07", "P01"});

  // A withdrawal on the server removes the code's join (the record that two codes are one person) at once,
  // before the station has carried it out.
  store::join(db, "P07", "P01");
  push(db, "station_a");
  server.query("SELECT turnpoint.withdraw('bench-a', 'P01')");
  CHECK(joins_on(postgres) == 1);
  collector::push({db, postgres.as("station_a"), "", folder / "received.json", {}, {}});
  CHECK(joins_on(postgres) == 1);
}

TEST_CASE("what is chosen is read from the server, and nothing else", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite", merged = folder / "merged.sqlite";
  const auto one = sample::session(a, 6);
  auto other = sample::start("P02");
  other.protocol_id = other.protocol_canonical = "other-protocol";
  sample::session(a, 5, other);
  sample::session(b, 4, at_station("bench-b", "P01"));
  collector::push({a, postgres.as("station_a"), "", "", {}, {}});
  collector::push({b, postgres.as("station_b"), "", "", {}, {}});
  store::merge(merged, a);
  store::merge(merged, b);
  const std::pair<store::SessionFilter, int> choices[] = {{{one, "", ""}, 6},
                                                          {{"", "P01", ""}, 10},
                                                          {{"", "P01@bench-b", ""}, 4},
                                                          {{"", "", "other-protocol"}, 5},
                                                          {{"", "P02", sample::start().protocol_id}, 0},
                                                          {{"", "", ""}, 15}};
  int number = 0;
  for (const auto& [filter, trials] : choices) {
    INFO(filter.session_id << " " << filter.participant << " " << filter.protocol_id);
    const collector::ReadableDatabase fetched(postgres.address("reader"), filter);
    auto copy = sample::raw(fetched.path());
    CHECK(copy.integer("SELECT count(*) FROM trial") == trials);
    CHECK(copy.integer("SELECT count(DISTINCT session_id) FROM link") ==
          copy.integer("SELECT count(DISTINCT session_id) FROM trial"));
    if (trials == 0) continue;
    const auto name = std::to_string(number++);
    CHECK(exported(fetched.path(), folder / (name + "-server"), filter) ==
          exported(merged, folder / (name + "-file"), filter));
  }
  // Rows that were changed on the server are refused when they are read.
  postgres.admin().query("UPDATE turnpoint.trial SET level = level + 1 WHERE session_id <> '" + one + "'");
  CHECK_NOTHROW(collector::ReadableDatabase(postgres.address("reader"), {one, "", ""}));
  CHECK_THROWS_AS(collector::ReadableDatabase(postgres.address("reader")), store::StoreError);
}

TEST_CASE("two stations with one name are told so before anything of the second is sent or withdrawn",
          "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite", replaced = folder / "replaced.sqlite";
  const auto now_on = [](const std::string& path, const std::string& machine) {
    auto database = sample::raw(path);
    store::move_station(database, machine);
  };
  const auto record = [&](const std::string& path, const std::string& code, const std::string& machine) {
    if (std::filesystem::exists(path)) now_on(path, machine);
    auto segment = sample::segment();
    segment.machine = machine;
    auto log = store::SessionLog::begin(path, sample::start(code), segment);
    log.begin_block(sample::block());
    log.append(sample::answered(0));
    log.finish(store::SessionStatus::completed, "");
  };
  const auto push = [&](const std::string& path, const std::string& role = "station_a") {
    now_on(
        path,
        store::machine_identity());  // the machine of this test, whose push is not refused for its own sake
    return collector::push({path, postgres.as(role), "", "", {}, {}});
  };
  const auto sessions = [&] { return postgres.admin().query("SELECT 1 FROM turnpoint.session").count(); };
  record(a, "P01", "board-1");
  record(b, "P01", "board-2");
  CHECK(push(a).complete());
  record(b, "P02", "board-2");
  std::string said;
  try {
    push(b);
  } catch (const collector::ServerError& error) {
    said = error.what();
  }
  CHECK(sample::contains(said, "another machine sends its sessions as station bench-a"));
  CHECK(sample::contains(said, "station-name --db " + b + " NEW-NAME --stored"));
  CHECK(sessions() == 1);
  // not even a withdrawal, which would delete the other station's P01
  store::withdraw(b, {"P01", "", "", ""});
  CHECK_THROWS_AS(push(b), collector::ServerError);
  CHECK(sessions() == 1);
  // the way out that the message names; bench-b has a role of its own
  now_on(b, "board-2");
  store::name_station(b, {"bench-b", store::Whose::found, true}, "board-2");
  CHECK(push(b, "station_b").complete());
  CHECK(sessions() == 2);
  // a new board that goes on with the database of the old one, even if a backup was restored
  sample::raw(a).execute("PRAGMA wal_checkpoint(TRUNCATE)");
  std::filesystem::copy_file(a, replaced);
  record(a, "P03", "board-1");
  CHECK(push(a).complete());
  record(replaced, "P01", "board-3");
  CHECK(push(replaced).complete());
  CHECK(sessions() == 4);
}

#include <fmt/format.h>

#include "station/collector/push.hpp"
#include "station/collector/received.hpp"
#include "station/collector/tables.hpp"
#include "station/core/number.hpp"
#include "station/store/merge.hpp"
#include "station/store/read.hpp"
#include "station/store/verify.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

std::string state_of(collector::Connection& server, const std::string& sql) {
  try {
    server.query(sql);
  } catch (const collector::ServerError& error) {
    return error.state();
  }
  return "allowed";
}

std::int64_t count(const PostgresServer& postgres, const std::string& from) {
  return postgres.admin().query("SELECT count(*) FROM turnpoint." + from).integer(0, 0);
}

store::SessionStart at_station(const std::string& station, const std::string& participant) {
  auto start = sample::start(participant);
  start.station_id = station;
  return start;
}

/// The hash in a tombstone of this code with the salt "s".
std::string hash_of(const std::string& code) { return core::sha256("s/" + code); }

/// Sends tombstones with a role, as a program of its own could.
void withdraw_as(const PostgresServer& postgres, const std::string& role,
                 const std::vector<store::Tombstone>& stones) {
  collector::Connection server(postgres.as(role));
  server.query("SELECT * FROM turnpoint.exchange_tombstones($1)", {collector::tombstones_json(stones)});
}

/// What a program of station bench-b sends instead of a recorded session: rows as the end of an INSERT.
using ForgedRows = std::vector<std::string>;

/// Sends the session "forged" with the role of bench-b. Returns the SQLSTATE of the refusal.
std::string state_of_forged(const PostgresServer& postgres, const ForgedRows& rows) {
  collector::Connection server(postgres.as("station_b"));
  server.query("SELECT turnpoint.prepare()");
  collector::ServerTransaction transaction(server);
  for (const auto& row : rows) server.query("INSERT INTO pg_temp.incoming_" + row);
  const auto state = state_of(server, "SELECT * FROM turnpoint.store_session('forged')");
  if (state == "allowed") transaction.commit();
  return state;
}

/// Returns a row that is stored on the server, with changed columns, as the end of an INSERT.
std::string stored(const PostgresServer& postgres, const std::string& table, const std::string& changes) {
  const auto row =
      postgres.admin().query("SELECT to_jsonb(t) || '" + changes + "' FROM turnpoint." + table + " t");
  return fmt::format("{0} SELECT * FROM jsonb_populate_record(NULL::turnpoint.{0}, {1})", table,
                     collector::literal(row.text(0, 0)));
}

}  // namespace

TEST_CASE("a station reads nothing, changes nothing and stores nothing that is another's", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto id = sample::session(db, 3);
  REQUIRE(collector::push({db, postgres.as("station_a"), "", "", {}, {}}).complete());
  collector::Connection b(postgres.as("station_b"));
  for (const auto& table : collector::collected_tables()) {
    INFO(table.name);
    for (const auto* role : {"station_a", "station_b"}) {
      collector::Connection station(postgres.as(role));
      CHECK(state_of(station, "SELECT 1 FROM turnpoint." + table.name) == "42501");
      CHECK(state_of(station, "DELETE FROM turnpoint." + table.name) == "42501");
    }
    // Even if somebody has granted a station the right to read a table by mistake, row security hides all
    // rows from it.
    postgres.admin().query("GRANT SELECT ON turnpoint." + table.name + " TO station_b");
    CHECK(b.query("SELECT 1 FROM turnpoint." + table.name).count() == 0);
  }
  CHECK(b.query("SELECT * FROM turnpoint.chains()").count() == 0);
  for (const auto* forbidden :
       {"SELECT turnpoint.withdraw('bench-a', 'P01')", "SELECT turnpoint.delete_withdrawn()",
        "SELECT turnpoint.is_own('bench-a')", "CREATE TEMPORARY TABLE incoming_trial (a int)",
        "CREATE TABLE turnpoint.mine (a int)", "CREATE SCHEMA mine", "SET ROLE turnpoint_owner",
        "SET SESSION AUTHORIZATION station_a"}) {
    INFO(forbidden);
    CHECK(state_of(b, forbidden) == "42501");
  }
  // A tombstone (the record of a withdrawal) for a session of another station has no effect.
  b.query("SELECT * FROM turnpoint.exchange_tombstones($1)",
          {fmt::format(R"([{{"session_id":"{}","salt":"s","participant_sha256":"","withdrawn_realtime_ns":1,)"
                       R"("station_id":"bench-b"}}])",
                       id)});
  CHECK(postgres.admin().query("SELECT 1 FROM turnpoint.session").count() == 1);
  CHECK(postgres.admin().query("SELECT 1 FROM turnpoint.tombstone").count() == 0);
  // Pushes the same database with the role of another station.
  const auto report = collector::push({db, postgres.as("station_b"), "", "", {}, {}});
  CHECK(report.sessions.empty());
  CHECK(report.unsent == std::vector<std::string>{"bench-a"});
  // They were recorded in this database, so nobody else sends them: that is no success.
  CHECK_FALSE(report.complete());
  // A reader may read but not change anything.
  collector::Connection reader(postgres.as("reader"));
  CHECK(reader.query("SELECT 1 FROM turnpoint.trial").count() == 3);
  CHECK(state_of(reader, "DELETE FROM turnpoint.trial") == "42501");
  CHECK(state_of(reader, "SELECT * FROM turnpoint.chains()") == "42501");
}

TEST_CASE("a withdrawal counts only if it is the station's own and agrees with the session", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  const auto theirs = sample::session(a, 3, sample::start("P01"));
  const auto own = sample::session(b, 2, at_station("bench-b", "P02"));
  sample::session(b, 2, at_station("bench-b", "P01"));
  REQUIRE(collector::push({a, postgres.as("station_a"), "", "", {}, {}}).complete());
  REQUIRE(collector::push({b, postgres.as("station_b"), "", "", {}, {}}).complete());
  const std::string unsent = "00000000-0000-4000-8000-000000000001";
  // Each of these is either about another station, or says something wrong about a session of bench-b.
  const std::vector<store::Tombstone> hostile = {{own, "s", hash_of("P01"), 1, "bench-b"},
                                                 {own, "s", hash_of("P02"), 1, "bench-a"},
                                                 {own, "s", hash_of("P01"), 1, ""},
                                                 {own, "s", hash_of("P01"), 1, "bench-a"},
                                                 {theirs, "s", hash_of("P01"), 1, "bench-a"},
                                                 {theirs, "s", hash_of("P01"), 1, "bench-b"},
                                                 {theirs, "s", "", 1, "bench-b"},
                                                 {theirs, "s", "", 1, ""},
                                                 {unsent, "s", hash_of("P01"), 1, "bench-a"},
                                                 {unsent, "s", hash_of("P01"), 1, ""}};
  for (const auto& stone : hostile) {
    INFO(stone.session_id << " " << stone.participant_sha256 << " " << stone.station_id);
    withdraw_as(postgres, "station_b", {stone});
    CHECK(count(postgres, "tombstone") == 0);
    CHECK(count(postgres, "session") == 3);
    CHECK(count(postgres, "enrolment") == 3);
  }
  // A tombstone that bench-b makes for a session which bench-a has not sent yet does not keep it out, and
  // does not stand in the way of the withdrawal by bench-a.
  const auto later = sample::session(a, 4, sample::start("P05"));
  withdraw_as(postgres, "station_b", {{later, "s", hash_of("P05"), 1, "bench-b"}});
  CHECK(collector::push({a, postgres.as("station_a"), "", "", {}, {}}).complete());
  CHECK(count(postgres, "session WHERE session_id = '" + later + "'") == 1);
  const auto never = sample::session(a, 4, sample::start("P06"));
  withdraw_as(postgres, "station_b", {{never, "s", hash_of("P06"), 1, "bench-b"}});
  store::withdraw(a, {"P06", "", "", ""});
  store::withdraw(a, {"P05", "", "", ""});
  CHECK(collector::push({a, postgres.as("station_a"), "", "", {}, {}}).complete());
  CHECK(count(postgres, "session WHERE session_id = '" + later + "'") == 0);
  CHECK(store::list_sessions(a).size() == 1);
  // What agrees is carried out, and only that.
  withdraw_as(postgres, "station_b", {{own, "s", hash_of("P02"), 1, "bench-b"}});
  CHECK(count(postgres, "session") == 2);
  CHECK(count(postgres, "enrolment WHERE participant = 'P02'") == 0);
  CHECK(count(postgres, "enrolment WHERE participant = 'P01'") == 2);
  for (const auto& db : {a, b}) CHECK(store::verify(db).good());
}

TEST_CASE("nobody but the administrator sees the hashes of codes that another station withdrew",
          "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  const auto gone = sample::session(a, 3, sample::start("P01"));
  sample::session(b, 2, at_station("bench-b", "P02"));
  REQUIRE(collector::push({a, postgres.as("station_a"), "", "", {}, {}}).complete());
  store::merge(b, a);  // bench-b has a copy of the session of bench-a
  store::withdraw(a, {"P01", "", "", ""});
  REQUIRE(collector::push({a, postgres.as("station_a"), "", "", {}, {}}).complete());
  collector::Connection other(postgres.as("station_b"));
  CHECK(other.query("SELECT * FROM turnpoint.exchange_tombstones('[]')").count() == 0);
  collector::Connection reader(postgres.as("reader"));
  CHECK(state_of(reader, "SELECT 1 FROM turnpoint.tombstone") == "42501");
  // A station that has the session hears of its withdrawal.
  const auto report = collector::push({b, postgres.as("station_b"), "", "", {}, {}});
  REQUIRE(report.withdrawn.sessions.size() == 1);
  CHECK(report.withdrawn.sessions.front().session_id == gone);
}

TEST_CASE("sessions that a station recorded under an earlier name are not overlooked", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "b.sqlite", other = folder / "a.sqlite";
  sample::session(db, 2, at_station("bench-b", "P01"));
  sample::session(other, 2, sample::start("P01"));
  store::merge(db, other);
  const collector::PushOptions options{db, postgres.as("station_b"), "", "", {}, {}};
  // Station bench-a sends its session itself.
  auto report = collector::push(options);
  CHECK(report.complete());
  CHECK(report.foreign == std::vector<std::string>{"bench-a"});
  sample::session(db, 2, at_station("renamed", "P02"));
  report = collector::push(options);
  CHECK_FALSE(report.complete());
  CHECK(report.unsent == std::vector<std::string>{"renamed"});
  postgres.admin().query("INSERT INTO turnpoint.station (station_id, role) VALUES ('renamed', 'station_b')");
  CHECK(collector::push(options).complete());
  CHECK(count(postgres, "session") == 2);
}

TEST_CASE(
    "rows that sessions share are stored only under the hash of their content, and only if the session "
    "refers to them",
    "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  auto start = sample::start();
  start.calibration_text = "measured";
  start.calibration_id = core::sha256(start.calibration_text);
  sample::session(db, 2, start);
  REQUIRE(collector::push({db, postgres.as("station_a"), "", "", {}, {}}).complete());
  const auto row = [&](const std::string& table, const std::string& changes = "{}") {
    return stored(postgres, table, changes);
  };
  const auto session =
      row("session", R"({"session_id":"forged", "station_id":"bench-b", "participant":"P09"})");
  const auto enrolment = row("enrolment", R"({"station_id":"bench-b", "participant":"P09"})");
  const auto protocol = row("protocol"), rig = row("rig"), calibration = row("calibration");
  const std::vector<ForgedRows> refused = {
      {row("protocol", R"({"text":"forged"})"), rig, calibration},
      {row("protocol", R"({"canonical":"forged"})"), rig, calibration},
      {row("protocol", R"({"sha256":"forged"})"), rig, calibration},
      {protocol, row("rig", R"({"name":"forged"})"), calibration},
      {protocol, row("rig", R"({"text":"forged"})"), calibration},
      {protocol, rig, row("calibration", R"({"text":"forged"})")},
      {protocol, rig, calibration, row("protocol", R"({"protocol_key":"x"})")},
      {protocol, rig, calibration, row("rig", R"({"rig_key":"x"})")},
      {protocol, rig, calibration, row("calibration", R"({"calibration_id":"x"})")},
      {protocol, rig, calibration, row("enrolment", R"({"station_id":"bench-b", "participant":"P99"})")},
      {protocol, rig, calibration},  // correct, but the session has no checksum
  };
  // Nothing is on the server with which the forged rows could be compared.
  for (const auto* table : {"session", "protocol", "rig", "calibration", "enrolment"})
    postgres.admin().query(std::string("DELETE FROM turnpoint.") + table);
  for (std::size_t i = 0; i < refused.size(); ++i) {
    INFO(i);
    auto rows = refused[i];
    rows.insert(rows.end(), {session, enrolment});
    CHECK(state_of_forged(postgres, rows) == "TP004");
  }
  for (const auto* table : {"session", "enrolment", "protocol", "rig", "calibration"})
    CHECK(count(postgres, table) == 0);
  // The honest session with this protocol, rig and calibration is stored.
  CHECK(collector::push({db, postgres.as("station_a"), "", "", {}, {}}).complete());
}

TEST_CASE("no station can hold a lock for which another waits", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 2);
  collector::Connection b(postgres.as("station_b"));
  for (const auto* forbidden : {"SELECT pg_advisory_lock(1)", "SELECT pg_try_advisory_xact_lock(1, 2)",
                                "SELECT lo_create(0)", "SELECT pg_notify('a', 'b')", "DO $$ BEGIN END $$"}) {
    INFO(forbidden);
    CHECK(state_of(b, forbidden) == "42501");
  }
  // No station can lease all places of a study.
  CHECK(state_of(b, "SELECT turnpoint.lease_places('other', 10000)") == "allowed");
  CHECK(state_of(b, "SELECT turnpoint.lease_places('other', 1)") == "TP003");
  // bench-b leases a place and leaves its transaction open. bench-a is told so, and what else it sends
  // arrives.
  b.query("SET idle_in_transaction_session_timeout = 0");
  collector::ServerTransaction open(b);
  b.query("SELECT turnpoint.lease_places('two-boundaries', 1)");
  postgres.admin().query("ALTER DATABASE turnpoint SET lock_timeout = '100ms'");
  const collector::PushOptions options{db, postgres.as("station_a"), "", "", {{"two-boundaries", 1}}, {}};
  try {
    collector::push(options);
    FAIL("leased");
  } catch (const collector::ServerError& error) {
    CHECK(error.state() == "55P03");
    CHECK(sample::contains(error.what(), "push again"));
  }
  CHECK(count(postgres, "session") == 1);
  // The server ends what has stood idle for longer than its limit.
  postgres.admin().query(
      "CREATE OR REPLACE FUNCTION turnpoint.longest_idle() RETURNS interval LANGUAGE sql AS $$ SELECT "
      "interval '0' $$");
  CHECK(collector::push(options).complete());
}

#include <fmt/format.h>

#include "station/collector/push.hpp"
#include "station/collector/tables.hpp"
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
  CHECK(report.foreign == std::vector<std::string>{"bench-a"});
  // A reader may read but not change anything.
  collector::Connection reader(postgres.as("reader"));
  CHECK(reader.query("SELECT 1 FROM turnpoint.trial").count() == 3);
  CHECK(state_of(reader, "DELETE FROM turnpoint.trial") == "42501");
  CHECK(state_of(reader, "SELECT * FROM turnpoint.chains()") == "42501");
}

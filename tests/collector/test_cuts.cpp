#include <fmt/format.h>

#include <mutex>
#include <random>
#include <thread>

#include "station/collector/fetch.hpp"
#include "station/collector/push.hpp"
#include "station/store/checksum.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/collector/proxy.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

std::string through(const Proxy& proxy, const std::string& role) {
  return fmt::format("host=127.0.0.1 port={} dbname=turnpoint user={} sslmode=disable", proxy.port(), role);
}

/// Checks that the server has each session of a database completely, or not at all. Returns how many it has.
int whole_sessions(const PostgresServer& postgres, const std::string& db) {
  const collector::ReadableDatabase fetched("postgresql:///turnpoint?host=" + postgres.folder() +
                                            "&user=reader");
  store::Database there(fetched.path(), store::Database::Access::read_only);
  store::Database here(db, store::Database::Access::read_only);
  store::Statement ids(here, "SELECT session_id FROM session");
  int whole = 0;
  while (ids.step()) {
    store::Statement known(there, "SELECT 1 FROM session WHERE session_id = ?");
    if (!known.bind(ids.text(0)).step()) continue;
    ++whole;
    CHECK(store::session_checksum(there, "main", ids.text(0)) ==
          store::session_checksum(here, "main", ids.text(0)));
  }
  return whole;
}

void empty(const PostgresServer& postgres) {
  postgres.admin().query(
      "WITH s AS (DELETE FROM turnpoint.session), e AS (DELETE FROM turnpoint.enrolment),"
      " p AS (DELETE FROM turnpoint.protocol) DELETE FROM turnpoint.rig");
}

int from_environment(const char* name, int otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? std::atoi(value) : otherwise;
}

}  // namespace

TEST_CASE("a push that is cut at any place leaves whole sessions, and the next push brings the rest",
          "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 2);
  sample::session(db, 2, sample::start("P02"));
  Trouble trouble;
  std::uint64_t sent = 0, received = 0;
  const auto connections = [&] { return trouble; };
  {
    Proxy proxy(postgres.socket(), connections);
    REQUIRE(collector::push({db, through(proxy, "station_a"), "", "", {}, {}}).complete());
    // The proxy serves one connection at a time, so the first one has been counted once this one is served.
    collector::Connection(through(proxy, "station_a")).query("SELECT 1");
    sent = proxy.sent();
    received = proxy.received();
  }
  REQUIRE(sent > 10000);
  REQUIRE(received > 500);
  std::mt19937 random(26);
  int failures = 0, seen[3] = {0, 0, 0};
  for (int i = 0; i < 24; ++i) {
    empty(postgres);
    trouble = {};
    if (i % 2 == 0)
      trouble.cut_sent = random() % sent;
    else
      trouble.cut_received = random() % received;
    {
      Proxy proxy(postgres.socket(), connections);
      try {
        collector::push({db, through(proxy, "station_a"), "", "", {}, {}});
      } catch (const collector::ServerError&) {
        ++failures;
      }
    }
    const int whole = whole_sessions(postgres, db);
    ++seen[whole];
    trouble = {};
    trouble.slow_sent = 1000;
    Proxy proxy(postgres.socket(), connections);
    const auto report = collector::push({db, through(proxy, "station_a"), "", "", {}, {}});
    REQUIRE(report.complete());
    CHECK(whole_sessions(postgres, db) == 2);
    int unchanged = 0;
    for (const auto& session : report.sessions)
      unchanged += session.what == collector::PushedSession::What::unchanged ? 1 : 0;
    CHECK(unchanged == whole);
  }
  CHECK(failures >= 20);
  CHECK(seen[0] > 0);
  CHECK(seen[1] > 0);  // sessions that were complete remain on the server although the push failed
}

TEST_CASE("bytes that change on the way are found, and nothing is stored", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 3);
  Trouble trouble;
  std::mt19937 random(27);
  int refused = 0;
  for (int i = 0; i < 20; ++i) {
    trouble = {};
    trouble.corrupt_sent = 400 + random() % 12000;
    {
      Proxy proxy(postgres.socket(), [&] { return trouble; });
      try {
        refused += collector::push({db, through(proxy, "station_a"), "", "", {}, {}}).complete() ? 0 : 1;
      } catch (const collector::ServerError&) {
        ++refused;
      }
    }
    // Checks that whatever the server accepted equals what the station has.
    whole_sessions(postgres, db);
    CHECK(collector::push({db, postgres.as("station_a"), "", "", {}, {}}).complete());
    CHECK(whole_sessions(postgres, db) == 1);
    empty(postgres);
  }
  CHECK(refused >= 15);
}

TEST_CASE("many stations push at once through a network that cuts, and nothing is lost or doubled",
          "[collector]") {
  const int stations = from_environment("TURNPOINT_COLLECTOR_STATIONS", 4);
  const int trials = from_environment("TURNPOINT_COLLECTOR_TRIALS", 160);
  const int per_session = std::min(50, trials / stations / 4);
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto file = [&](int k) { return folder / fmt::format("station-{}.sqlite", k); };
  int made = 0;
  for (int k = 0; k < stations; ++k) {
    postgres.add_station(fmt::format("lab-{}", k), fmt::format("station_{}", k));
    for (int n = 0; n < trials / stations; n += per_session) {
      auto start = sample::start(fmt::format("P{}", n));
      start.station_id = fmt::format("lab-{}", k);
      sample::session(file(k), per_session, start);
      made += per_session;
    }
  }
  std::atomic<int> cuts = 0;
  {
    std::vector<std::jthread> pushing;
    for (int k = 0; k < stations; ++k)
      pushing.emplace_back([&, k] {
        std::mt19937 random(static_cast<unsigned>(k));
        // Each time a push comes further, let the next one come further still, so that the test ends.
        std::uint64_t reach = 8000;
        Proxy proxy(postgres.socket(), [&] {
          Trouble trouble;
          reach += reach / 8;
          (random() % 2 == 0 ? trouble.cut_sent : trouble.cut_received) = random() % reach;
          return trouble;
        });
        for (bool done = false; !done;) try {
            done = collector::push({file(k), through(proxy, fmt::format("station_{}", k)), "", "", {}, {}})
                       .complete();
          } catch (const collector::ServerError&) {
            ++cuts;
          }
      });
  }
  auto server = postgres.admin();
  CHECK(server.query("SELECT count(*) FROM turnpoint.trial").integer(0, 0) == made);
  CHECK(server.query("SELECT count(*) FROM (SELECT DISTINCT session_id, onset_ns FROM turnpoint.trial) x")
            .integer(0, 0) == made);
  CHECK(cuts >= stations);
  int whole = 0;
  for (int k = 0; k < stations; ++k) whole += whole_sessions(postgres, file(k));
  CHECK(whole == made / per_session);
}

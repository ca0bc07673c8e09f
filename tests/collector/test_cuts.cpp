#include <fmt/format.h>

#include <atomic>
#include <cstdlib>
#include <random>
#include <thread>

#include "station/collector/push.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/collector/proxy.hpp"
#include "tests/collector/whole_sessions.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

std::string through(const Proxy& proxy, const std::string& role) {
  return fmt::format("host=127.0.0.1 port={} dbname=turnpoint user={} sslmode=disable", proxy.port(), role);
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

TEST_CASE("a byte that changes under TLS breaks the connection, and no session is stored by half",
          "[collector]") {
  const PostgresServer postgres({true, ""});
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  sample::session(db, 3);
  sample::session(db, 3, sample::start("P02"));
  const auto push = [&](const Proxy& proxy) {
    return collector::push(
        {db,
         fmt::format(
             "host=localhost hostaddr=127.0.0.1 port={} dbname=turnpoint user=station_a sslrootcert={}",
             proxy.port(), postgres.certificate()),
         "",
         "",
         {},
         {}});
  };
  Trouble trouble;
  trouble.tls = true;
  std::uint64_t sent = 0, received = 0;
  {
    Proxy proxy(std::to_string(postgres.port()), [&] { return trouble; });
    REQUIRE(push(proxy).complete());
    REQUIRE(push(proxy).complete());  // the first connection is counted when the next is served
    sent = proxy.sent();
    received = proxy.received();
  }
  std::mt19937 random(28);
  int broken = 0, seen[3] = {0, 0, 0};
  for (int i = 0; i < 24; ++i) {
    empty(postgres);
    trouble.corrupt_sent = trouble.corrupt_received = Trouble::kNever;
    if (i % 3 != 0)
      trouble.corrupt_sent = random() % sent;
    else
      trouble.corrupt_received = random() % received;
    {
      Proxy proxy(std::to_string(postgres.port()), [&] { return trouble; });
      try {
        // The push succeeds only if the changed byte comes after all data, at the end of the connection.
        const bool complete = push(proxy).complete();
        CHECK(complete);
      } catch (const collector::ServerError& error) {
        INFO(error.what());
        CHECK(error.state().empty());  // the connection was lost, so no changed byte was taken for data
        ++broken;
      }
    }
    ++seen[whole_sessions(postgres, db)];
  }
  CHECK(broken >= 20);
  CHECK(seen[0] > 0);
  CHECK(seen[1] > 0);
  trouble.corrupt_sent = trouble.corrupt_received = Trouble::kNever;
  Proxy proxy(std::to_string(postgres.port()), [&] { return trouble; });
  CHECK(push(proxy).complete());
  CHECK(whole_sessions(postgres, db) == 2);
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
        // Cut each connection later than the one before, so that the push succeeds in the end.
        std::uint64_t sent = 8000, received = 800;
        Proxy proxy(postgres.socket(), [&] {
          Trouble trouble;
          sent += sent / 4;
          received += received / 4;
          if (random() % 2 == 0)
            trouble.cut_sent = random() % sent;
          else
            trouble.cut_received = random() % received;
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
  std::vector<std::string> files;
  for (int k = 0; k < stations; ++k) files.push_back(file(k));
  CHECK(whole_sessions(postgres, files) == made / per_session);
  if (std::getenv("TURNPOINT_COLLECTOR_TRIALS") != nullptr)
    WARN(made << " trials from " << stations << " stations, " << cuts << " pushes were cut");
}

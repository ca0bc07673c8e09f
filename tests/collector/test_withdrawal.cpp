#include "station/collector/push.hpp"
#include "station/store/read.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

std::int64_t rows_about(const PostgresServer& postgres, const std::string& id) {
  auto server = postgres.admin();
  std::int64_t count = 0;
  for (const auto* table : {"session", "segment", "block", "trial", "tone", "signal", "event", "link"})
    count +=
        server.query(std::string("SELECT count(*) FROM turnpoint.") + table + " WHERE session_id = $1", {id})
            .integer(0, 0);
  return count;
}

}  // namespace

TEST_CASE("what is withdrawn on a station is deleted on the server", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  const auto gone = sample::session(db, 4), kept = sample::session(db, 3, sample::start("P02"));
  const collector::PushOptions options{db, postgres.as("station_a"), "", "", {}, {}};
  REQUIRE(collector::push(options).complete());
  CHECK(rows_about(postgres, gone) > 0);
  postgres.run("pg_dump", "-h " + postgres.folder() + " -U postgres -d turnpoint -f before.sql");

  store::withdraw(db, {"P01", "", "", ""});
  REQUIRE(collector::push(options).complete());
  CHECK(rows_about(postgres, gone) == 0);
  CHECK(rows_about(postgres, kept) > 0);
  auto server = postgres.admin();
  CHECK(server.query("SELECT 1 FROM turnpoint.enrolment WHERE participant = 'P01'").count() == 0);

  // If the server is restored from an older backup, withdrawn data come back, but only until the next contact
  // with the station.
  server.query("DROP SCHEMA turnpoint CASCADE");
  postgres.run("psql", "-q -h " + postgres.folder() + " -U postgres -d turnpoint -f before.sql");
  CHECK(rows_about(postgres, gone) > 0);
  REQUIRE(collector::push(options).complete());
  CHECK(rows_about(postgres, gone) == 0);
  CHECK(rows_about(postgres, kept) > 0);
}

TEST_CASE("what is withdrawn on the server is deleted on the station at its next contact", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite", other = folder / "b.sqlite";
  auto start = sample::start("SECRET-CODE");
  start.protocol_id = "only-here";
  const auto gone = sample::session(db, 4, start), kept = sample::session(db, 3, sample::start("P02"));
  const collector::PushOptions options{db, postgres.as("station_a"), "", "", {}, {}};
  REQUIRE(collector::push(options).complete());
  CHECK(postgres.admin().query("SELECT turnpoint.withdraw('bench-a', 'SECRET-CODE')").integer(0, 0) == 1);
  CHECK(rows_about(postgres, gone) == 0);

  {
    // While a session runs, only its process may write to the database.
    auto log = store::SessionLog::begin(db, sample::start("P03"), sample::segment());
    const auto report = collector::push(options);
    CHECK_FALSE(report.complete());
    CHECK(sample::contains(report.waiting, "another station process"));
    CHECK(rows_about(postgres, gone) == 0);
    log.finish(store::SessionStatus::completed, "");
  }
  auto report = collector::push(options);
  CHECK(report.complete());
  REQUIRE(report.withdrawn.sessions.size() == 1);
  CHECK(report.withdrawn.sessions[0].session_id == gone);
  CHECK(rows_about(postgres, gone) == 0);
  CHECK(store::list_sessions(db).size() == 2);
  CHECK_FALSE(sample::contains(sample::bytes_of(db), "SECRET-CODE"));
  // The station must not assign the code again.
  CHECK(sample::failure([&] { sample::session(db, 1, start); }).first == store::ErrorKind::refused);
  CHECK(collector::push(options).withdrawn.sessions.empty());
  CHECK(store::list_sessions(db).size() == 2);
}

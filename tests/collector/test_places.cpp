#include <set>

#include "station/collector/fetch.hpp"
#include "station/collector/push.hpp"
#include "station/collector/received.hpp"
#include "station/core/number.hpp"
#include "station/store/places.hpp"
#include "station/store/read.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

namespace {

const std::string kProtocol = sample::start().protocol_id;

store::SessionStart at_station(const std::string& station, const std::string& participant) {
  auto start = sample::start(participant);
  start.station_id = station;
  return start;
}

std::set<int> places_in(const std::string& db) {
  std::set<int> places;
  for (const auto& session : store::list_sessions(db)) places.insert(session.sequence_index);
  return places;
}

}  // namespace

TEST_CASE("leased places make one design over two stations, also while the server is away", "[collector]") {
  PostgresServer postgres;
  const TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  sample::session(a, 1, at_station("bench-a", "A0"));
  sample::session(b, 1,
                  // both stations assigned this place before they shared the design
                  at_station("bench-b", "B0"));
  CHECK(places_in(a) == places_in(b));
  const auto lease = [&](const std::string& db, const std::string& role, std::int64_t count) {
    collector::PushOptions options{db, postgres.as(role), "", "", {}, {}};
    if (count > 0) options.places[kProtocol] = count;
    return collector::push(options);
  };
  lease(a, "station_a", 0);
  lease(b, "station_b", 0);
  CHECK(lease(a, "station_a", 3).places.at(kProtocol) == 3);
  CHECK(lease(b, "station_b", 2).places.at(kProtocol) == 2);
  // the station gets no more places than it asks for
  CHECK(lease(a, "station_a", 3).places.at(kProtocol) == 3);
  postgres.stop();
  for (const auto* code : {"A1", "A2", "A3"}) sample::session(a, 1, at_station("bench-a", code));
  for (const auto* code : {"B1", "B2"}) sample::session(b, 1, at_station("bench-b", code));
  CHECK(places_in(a) == std::set<int>{0, 1, 2, 3});
  CHECK(places_in(b) == std::set<int>{0, 4, 5});
  // A known participant keeps the place in the counterbalancing. A new participant must not get a place that
  // may belong to another station.
  sample::session(a, 1, at_station("bench-a", "A1"));
  const auto [kind, message] = sample::failure([&] { sample::session(a, 1, at_station("bench-a", "A4")); });
  CHECK(kind == store::ErrorKind::refused);
  CHECK(sample::contains(message, "--places " + kProtocol));
  postgres.start();
  CHECK(lease(a, "station_a", 2).complete());
  sample::session(a, 1, at_station("bench-a", "A4"));
  CHECK(places_in(a) == std::set<int>{0, 1, 2, 3, 6});

  // A place that one station gives back can be leased to another station.
  collector::PushOptions give_back{a, postgres.as("station_a"), "", "", {}, {kProtocol}};
  CHECK(collector::push(give_back).complete());
  CHECK(lease(b, "station_b", 2).places.at(kProtocol) == 2);
  sample::session(b, 1, at_station("bench-b", "B3"));
  CHECK(places_in(b) == std::set<int>{0, 4, 5, 7});

  // Whether a place was leased is stored with the session, at the station and on the server.
  CHECK(lease(b, "station_b", 0).complete());
  const collector::ReadableDatabase fetched(postgres.address("reader"));
  for (const auto& path : {b, fetched.path()})
    for (const auto& session : store::list_sessions(path)) {
      INFO(session.start.participant);
      CHECK(session.leased_place == (session.start.participant != "A0" && session.start.participant != "B0"));
    }
}

TEST_CASE("what the server sent can be carried out later, by another user", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite", file = folder / "received.json";
  sample::session(db, 2);
  sample::session(db, 2, sample::start("P02"));
  collector::PushOptions options{db, postgres.as("station_a"), "", file, {{kProtocol, 2}}, {}};
  REQUIRE(collector::push(options).complete());
  postgres.admin().query("SELECT turnpoint.withdraw('bench-a', 'P01')");
  const auto before = sample::bytes_of(db);
  REQUIRE(collector::push(options).complete());
  CHECK(sample::bytes_of(db) == before);
  CHECK(store::list_sessions(db).size() == 2);
  CHECK(postgres.admin().query("SELECT 1 FROM turnpoint.session").count() == 1);
  CHECK(collector::carry_out(collector::read_received(file), db, "").sessions.size() == 1);
  CHECK(store::list_sessions(db).size() == 1);
  sample::session(db, 1, sample::start("P03"));
  CHECK(places_in(db) == std::set<int>{1, 2});
  std::ofstream(file) << "{}";
  CHECK_THROWS(collector::read_received(file));
}

TEST_CASE("the example queries run for a reader, and count what was recorded", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  auto start = sample::start();
  start.run_mode = store::RunMode::live;
  start.observer = "";
  start.calibration_text = "format = \"x\"\nmade_on = 2023-02-28\n";
  start.calibration_id = core::sha256(start.calibration_text);
  sample::session(folder / "a.sqlite", 10, start);
  REQUIRE(collector::push({folder / "a.sqlite", postgres.as("station_a"), "", "", {}, {}}).complete());
  std::filesystem::copy_file(TURNPOINT_SOURCE_DIR "/station/collector/queries.sql",
                             postgres.folder() + "/queries.sql");
  postgres.run("psql", "-v ON_ERROR_STOP=1 -At -h " + postgres.folder() +
                           " -U reader -d turnpoint -f queries.sql -o answers");
  const auto answers = sample::bytes_of(postgres.folder() + "/answers");
  CHECK(sample::contains(answers, "bench-a|2024-02-29|1|10\n"));
  // Every fifth trial of the sample is a timeout, so 2 of 10 are.
  CHECK(sample::contains(answers, "|10|2|0\n"));
  CHECK(sample::contains(answers, "|2023-02-28|366\n"));
}

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "station/collector/fetch.hpp"
#include "station/collector/push.hpp"
#include "station/collector/received.hpp"
#include "station/core/number.hpp"
#include "station/store/open.hpp"
#include "station/store/people.hpp"
#include "station/store/places.hpp"
#include "station/store/read.hpp"
#include "station/store/withdraw.hpp"
#include "station/system/clocks.hpp"
#include "tests/collector/postgres_server.hpp"
#include "tests/collector/proxy.hpp"
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

namespace {

constexpr std::int64_t hour_ns = 3'600'000'000'000;

const core::Assignment kFourRows{48, 4, 1, false};

/// Records a session that began some hours ago. Its trials, if it has any, are of now. Returns the
/// participant's place.
int live(const std::string& db, const std::string& station, const std::string& participant, double hours_ago,
         store::SessionStatus status = store::SessionStatus::completed,
         const std::optional<core::Assignment>& assignment = kFourRows, std::optional<int> planned = {},
         store::RunMode mode = store::RunMode::live, int trials = 0) {
  auto start = at_station(station, participant);
  start.run_mode = mode;
  if (mode != store::RunMode::simulated) start.observer = "";
  start.assignment = assignment;
  start.planned_session = planned;
  auto segment = sample::segment();
  segment.realtime_ns =
      system::realtime_ns() - static_cast<std::int64_t>(hours_ago * static_cast<double>(hour_ns));
  auto log = store::SessionLog::begin(db, start, segment);
  log.begin_block(sample::block());
  for (int i = 0; i < trials; ++i) log.presented(i, 1), log.append(sample::answered(i));
  log.finish(status, "");
  return log.session().sequence_index;
}

/// Sends the sessions of a station, and leases places until it has this many free ones.
void lease(const std::string& db, const std::string& to, std::int64_t count,
           const std::optional<core::Assignment>& assignment = kFourRows) {
  collector::PushOptions options{db, to, "", "", {{kProtocol, count}}, {}};
  options.assignment = [&](auto&&...) { return assignment; };
  REQUIRE(collector::push(options).complete());
}

}  // namespace

TEST_CASE("a station replaces the dropouts of another", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto a = folder / "a.sqlite", b = folder / "b.sqlite";
  const auto to_a = postgres.as("station_a"), to_b = postgres.as("station_b");
  sample::session(a, 1, at_station("bench-a", "S")), sample::session(b, 1, at_station("bench-b", "S"));
  store::withdraw(a, {"S", "", "", ""}), store::withdraw(b, {"S", "", "", ""});
  lease(a, to_a, 2), lease(b, to_b, 2);
  CHECK(live(a, "bench-a", "A0", 100) == 0);
  CHECK(live(a, "bench-a", "A1", 100, store::SessionStatus::stopped) == 1);
  CHECK(live(b, "bench-b", "B0", 100) == 2);
  CHECK(live(b, "bench-b", "B1", 100) == 3);
  collector::push({a, to_a, "", "", {}, {}});
  SECTION("without the rule, it gets the lowest place") {
    lease(b, to_b, 1, std::nullopt);
    CHECK(live(b, "bench-b", "B2", 0) == 4);
  }
  SECTION("with it, it gets one in the row of the dropout") {
    lease(b, to_b, 1);
    CHECK(live(b, "bench-b", "B2", 0) == 5);
    SECTION("and if the dropout comes back, the next ones go to the other rows") {
      CHECK(live(a, "bench-a", "A1", 0) == 1);
      lease(a, to_a, 3);
      lease(b, to_b, 1);
      std::set<int> places;
      for (const auto* code : {"A2", "A3", "A4"}) places.insert(live(a, "bench-a", code, 0));
      CHECK(places == std::set<int>{4, 6, 7});
      CHECK(live(b, "bench-b", "B3", 0) == 8);
    }
  }
  SECTION("while a dropout is expected, the row is not given again") {
    const core::Assignment patient{200, 4, 1, false};
    lease(b, to_b, 1, patient);
    CHECK(live(b, "bench-b", "B2", 0, store::SessionStatus::completed, patient) == 4);
  }
}

TEST_CASE("the sessions are sent although no place can be leased", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  live(db, "bench-a", "A0", 100);
  collector::PushOptions options{db, postgres.as("station_a"), "", "", {{kProtocol, 2}}, {}};
  SECTION("because the protocol cannot be read") {
    options.assignment = [](const auto&, const auto& stations) -> std::optional<core::Assignment> {
      CHECK(stations == std::set<std::string>{"bench-a"});
      throw std::runtime_error("cannot be read");
    };
    CHECK_THROWS_WITH(collector::push(options), "cannot be read");
  }
  SECTION("because the server was not updated") {
    postgres.admin().query("DROP FUNCTION turnpoint.lease_places(text, bigint, json)");
    CHECK_THROWS_WITH(collector::push(options),
                      Catch::Matchers::ContainsSubstring("deploy/collector upgrade"));
  }
  CHECK(postgres.admin().query("SELECT 1 FROM turnpoint.session").count() == 1);
}

TEST_CASE("the server counts and chooses as a station does", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  std::mt19937 random(46);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  using store::SessionStatus;
  for (const auto& [station, role] : {std::pair("bench-a", "station_a"), {"bench-b", "station_b"}}) {
    const auto db = folder / (std::string(station) + ".sqlite");
    // places that neither the one nor the other has, so that the server need not lease any
    std::vector<std::int64_t> mine;
    for (int i = 0; i < 60; ++i)
      if (const bool of_a = i % 3 == 0; of_a == (std::string(station) == "bench-a")) mine.push_back(i);
    for (int i = 0; i < 30; ++i) {
      const auto code = "P" + std::to_string(below(14));
      const auto status =
          std::vector{SessionStatus::completed, SessionStatus::completed, SessionStatus::stopped,
                      SessionStatus::interrupted}[static_cast<std::size_t>(below(4))];
      live(db, station, code, below(400), status, kFourRows,
           below(5) == 0 ? std::nullopt : std::optional(1 + below(3)),
           below(6) == 0 ? store::RunMode::pilot : store::RunMode::live, below(4) == 0 ? 1 : 0);
      if (i == 0) store::set_leased_places(db, kProtocol, mine);
    }
    if (const auto codes = store::participants(db); std::string(station) == "bench-a")
      store::join(db, codes[0], codes[1]);
    REQUIRE(collector::push({db, postgres.as(role), "", "", {}, {}}).complete());
  }
  auto admin = postgres.admin();
  const auto people = admin.query(
      "SELECT a.participant, b.participant FROM turnpoint.enrolment a, turnpoint.enrolment b WHERE "
      "a.station_id"
      " = 'bench-a' AND b.station_id = 'bench-b' ORDER BY 1, 2 LIMIT 1");
  admin.query("SELECT turnpoint.join('bench-a', $1, 'bench-b', $2)", {people.text(0, 0), people.text(0, 1)});
  const collector::ReadableDatabase fetched(postgres.address("reader"));
  auto reader = store::open_reader(fetched.path());
  int held = 0, gone = 0;
  for (int run = 0; run < 60; ++run) {
    const core::Assignment rule{static_cast<double>(1 + below(400)), 1 + below(7), 1 + below(3),
                                below(2) == 1};
    const auto json = "{\"dropout_after_h\":" + core::number(rule.dropout_after_h) +
                      ",\"rows\":" + std::to_string(rule.rows) +
                      ",\"sessions\":" + std::to_string(rule.sessions) +
                      ",\"incomplete_count\":" + (rule.incomplete_count ? "true" : "false") + "}";
    INFO(json);
    std::multiset<std::int64_t> here, there;
    std::map<std::int64_t, std::int64_t> rows;
    for (const auto& one :
         store::participations(reader, kProtocol, store::RunMode::live, rule, system::realtime_ns())) {
      if (one.progress == store::Progress::dropped_out) {
        ++gone;
        continue;
      }
      here.insert(one.place), ++rows[one.place % rule.rows], ++held;
    }
    const auto found = admin.query("SELECT * FROM turnpoint.held_places($1, $2)", {kProtocol, json});
    for (int i = 0; i < found.count(); ++i) there.insert(found.integer(i, 0));
    REQUIRE(here == there);
    // The server leases several places as one after the other would be chosen here.
    collector::Connection b(postgres.as("station_b"));
    const collector::ServerTransaction undone(b);
    const auto leased = [&](int more) {
      std::set<std::int64_t> places;
      const auto list =
          b.query("SELECT turnpoint.lease_places($1, $2, $3)", {kProtocol, std::to_string(more), json});
      for (int i = 0; i < list.count(); ++i) places.insert(list.integer(i, 0));
      return places;
    };
    auto used = store::used_places(reader, kProtocol);
    std::set<std::int64_t> expected;
    for (int step = 0; step < 2; ++step) {  // the second time, the places of the first are leased and free
      const int more = below(12);
      for (int i = 0; i < more; ++i) {
        const auto place = *store::choose_place(used, std::nullopt, rows, rule.rows);
        expected.insert(place), ++rows[place % rule.rows];
        used.insert(std::lower_bound(used.begin(), used.end(), place), place);
      }
      REQUIRE(leased(more) == expected);
    }
  }
  CHECK(held > 100);
  CHECK(gone > 100);
}

TEST_CASE("two stations that enrol at the same time get different places, and rows even out", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto enrol = [&](const std::string& letter, int count, int seed, int leaving_percent) {
    std::mt19937 random(static_cast<unsigned>(seed));
    const auto db = folder / (letter + ".sqlite");
    for (int i = 0; i < count; ++i) {
      const bool leaves = static_cast<int>(random() % 100) < leaving_percent;
      collector::PushOptions options{db, postgres.as("station_" + letter), "", "", {{kProtocol, 1}}, {}};
      options.assignment = [](auto&&...) { return std::optional(kFourRows); };
      for (int attempt = 0;; ++attempt) {
        try {
          if (std::filesystem::exists(db)) collector::push(options);
          break;
        } catch (const collector::ServerError& error) {
          if (attempt == 5) throw;
        }
      }
      live(db, "bench-" + letter, letter + std::to_string(seed) + "-" + std::to_string(i), 100,
           leaves ? store::SessionStatus::stopped : store::SessionStatus::completed);
    }
    collector::push({db, postgres.as("station_" + letter), "", "", {}, {}});
  };
  const auto both = [&](int count, int seed, int leaving_percent) {
    std::jthread a([&] { enrol("a", count, seed, leaving_percent); });
    std::jthread b([&] { enrol("b", count, seed + 1, leaving_percent); });
  };
  // The first participant of each station comes before any lease: both have place 0.
  both(1, 10, 0);
  both(14, 20, 30);
  const auto count = [&](const std::string& what) {
    return postgres.admin().query("SELECT " + what + " FROM turnpoint.enrolment").integer(0, 0);
  };
  CHECK(count("count(*)") == 30);
  CHECK(count("count(DISTINCT sequence_index)") == 29);
  const auto difference = [&] {
    const auto rows = postgres.admin().query(
        "SELECT count(s.session_id) FROM generate_series(0, 3) r LEFT JOIN turnpoint.session s"
        " ON s.sequence_index % 4 = r AND s.status = 'completed' GROUP BY r ORDER BY 1");
    return rows.integer(3, 0) - rows.integer(0, 0);
  };
  CAPTURE(difference());
  // Without dropouts, four more of each station even out what the last dropouts left.
  both(4, 30, 0);
  CHECK(difference() <= 1);
}

TEST_CASE("a lease that is cut at any place is completed by the next push", "[collector]") {
  const PostgresServer postgres;
  const TemporaryFolder folder;
  const auto db = folder / "a.sqlite";
  live(db, "bench-a", "A0", 100, store::SessionStatus::stopped);
  std::mt19937 random(7);
  int failures = 0;
  for (int i = 0; i < 16; ++i) {
    Trouble trouble;
    (i % 2 == 0 ? trouble.cut_sent : trouble.cut_received) = 600 + random() % 3000;
    const auto connections = [&] { return trouble; };
    const Proxy proxy(postgres.socket(), connections);
    collector::PushOptions options{db,
                                   "host=127.0.0.1 port=" + std::to_string(proxy.port()) +
                                       " dbname=turnpoint user=station_a sslmode=disable",
                                   "",
                                   "",
                                   {{kProtocol, 2}},
                                   {}};
    options.assignment = [](auto&&...) { return std::optional(kFourRows); };
    try {
      collector::push(options);
    } catch (const collector::ServerError&) {
      ++failures;
    }
    lease(db, postgres.as("station_a"), 2);
    const auto list = postgres.admin().query("SELECT sequence_index FROM turnpoint.lease ORDER BY 1");
    auto here = sample::raw(db);
    CHECK(
        here.text("SELECT group_concat(sequence_index) FROM (SELECT * FROM lease ORDER BY sequence_index)") ==
        [&] {
          std::string text;
          for (int row = 0; row < list.count(); ++row) text += (row > 0 ? "," : "") + list.text(row, 0);
          return text;
        }());
    live(db, "bench-a", "A" + std::to_string(i + 1), 100);
    // never more free places than were asked for, whatever was cut
    CHECK(here.integer("SELECT count(*) FROM lease WHERE sequence_index NOT IN"
                       " (SELECT sequence_index FROM enrolment)") == 1);
  }
  CHECK(failures > 4);
}

#include "station/store/places.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>

#include "station/store/merge.hpp"
#include "station/store/people.hpp"
#include "station/store/read.hpp"
#include "station/store/verify.hpp"
#include "station/store/withdraw.hpp"
#include "station/system/clocks.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

constexpr std::int64_t hour_ns = 3'600'000'000'000;

/// A study with four rows in one database. Times are hours after the moment at which the study was made,
/// because the time of a trial is always that of the clock.
struct Lab {
  TemporaryFolder folder;
  std::string db = folder / "lab.sqlite";
  std::int64_t begin_ns = turnpoint::system::realtime_ns();
  std::optional<Assignment> assignment = Assignment{48, 4, 1, false};
  RunMode mode = RunMode::live;
  std::string station = "bench-a";

  SessionStart start(const std::string& code, std::optional<int> planned = {}) const {
    auto start = sample::start(code);
    start.station_id = station;
    start.run_mode = mode;
    if (mode != RunMode::simulated) start.observer = "";
    start.planned_session = planned;
    start.assignment = assignment;
    start.groups = {};
    return start;
  }

  SegmentStart at(double hour) const {
    auto segment = sample::segment();
    segment.realtime_ns = begin_ns + static_cast<std::int64_t>(hour * static_cast<double>(hour_ns));
    return segment;
  }

  /// Records a session without trials. Returns the participant's place.
  int session(const std::string& code, double hour, SessionStatus status = SessionStatus::completed,
              std::optional<int> planned = {}, int trials = 0) const {
    auto log = SessionLog::begin(db, start(code, planned), at(hour));
    log.begin_block(sample::block());
    for (int i = 0; i < trials; ++i) {
      log.presented(i, 1);
      log.append(sample::answered(i));
    }
    log.finish(status, "");
    return log.session().sequence_index;
  }

  int leaves(const std::string& code, double hour) const {
    return session(code, hour, SessionStatus::stopped);
  }
};

}  // namespace

TEST_CASE("without [assignment], the next participant gets the lowest free place, whoever dropped out",
          "[store]") {
  Lab lab;
  lab.assignment.reset();
  CHECK(lab.session("A", 0) == 0);
  CHECK(lab.leaves("B", 1) == 1);
  CHECK(lab.session("C", 1000) == 2);
  CHECK(lab.session("B", 1001) == 1);
  withdraw(lab.db, {"A", "", "", ""});
  CHECK(lab.session("D", 1002) == 0);
  CHECK(lab.session("E", 1003) == 3);
}

TEST_CASE("with [assignment], the row of a dropout goes to the next participant once the time is over",
          "[store]") {
  const Lab lab;
  CHECK(lab.session("A", 0) == 0);
  CHECK(lab.leaves("B", 1) == 1);
  CHECK(lab.session("C", 2) == 2);
  CHECK(lab.session("D", 48.9) == 3);  // B is still expected, for 6 minutes
  CHECK(lab.session("E", 49.1) == 5);  // the row of B, and a place of its own
  CHECK(lab.session("F", 50) == 4);
  CHECK(lab.leaves("G", 51) == 6);  // rows 0 and 1 have two
  SECTION("a dropout who comes back keeps the place, and the others are evened out") {
    CHECK(lab.session("B", 60) == 1);
    for (const auto& [code, place] : {std::pair("H", 7), {"I", 8}}) CHECK(lab.session(code, 61) == place);
    CHECK(lab.session("J", 100) == 10);  // G is gone: row 2 has one
    CHECK(lab.session("K", 101) == 9);   // row 0 has three, the others have two
    CHECK(lab.session("L", 102) == 11);
    CHECK(lab.session("M", 103) == 14);
    CHECK(lab.session("N", 104) == 12);  // all have three
  }
  SECTION("somebody who goes on in time is no dropout") {
    CHECK(lab.leaves("G", 80) == 6);
    CHECK(lab.session("H", 110) == 7);
    CHECK(lab.session("I", 111) == 9);
    CHECK(lab.session("J", 127.9) == 8);
    CHECK(lab.session("K", 128.1) == 10);
  }
  SECTION("a withdrawn participant leaves the place at once") {
    withdraw(lab.db, {"A", "", "", ""});
    CHECK(lab.session("H", 61) == 0);
  }
}

TEST_CASE("a participant has completed when all planned sessions are done", "[store]") {
  Lab lab;
  lab.assignment = Assignment{100, 2, 2, false};
  CHECK(lab.session("A", 0, SessionStatus::completed, 1) == 0);
  CHECK(lab.session("A", 10, SessionStatus::completed, 2) == 0);
  CHECK(lab.session("B", 11, SessionStatus::completed, 1) == 1);
  CHECK(lab.session("B", 12, SessionStatus::completed, 1) == 1);  // the same session twice is one
  CHECK(lab.session("C", 13, SessionStatus::completed, 1) == 2);
  CHECK(lab.session("C", 14, SessionStatus::stopped, 2, 3) == 2);
  auto reader = sample::raw(lab.db);
  const auto progress = [&](bool incomplete_count, double hour) {
    auto rule = *lab.assignment;
    rule.incomplete_count = incomplete_count;
    std::string words;
    for (const auto& one :
         participations(reader, sample::start().protocol_id, RunMode::live, rule, lab.at(hour).realtime_ns))
      words += one.progress == Progress::completed ? "c" : one.progress == Progress::expected ? "e" : "d";
    return words;
  };
  CHECK(progress(false, 15) == "cee");
  CHECK(progress(false, 111.9) == "cee");
  CHECK(progress(false, 112.1) == "cde");
  CHECK(progress(false, 1000) == "cdd");
  CHECK(progress(true, 1000) == "cdc");  // "count": a session with trials is done
  CHECK(lab.session("D", 1000, SessionStatus::completed, 1) == 3);
}

TEST_CASE("a session that runs is expected, however long it takes", "[store]") {
  const Lab lab;
  const auto log = SessionLog::begin(lab.db, lab.start("A"), lab.at(0));
  auto reader = sample::raw(lab.db);
  const auto list = participations(reader, sample::start().protocol_id, RunMode::live, *lab.assignment,
                                   lab.at(1000).realtime_ns);
  REQUIRE(list.size() == 1);
  CHECK(list[0].progress == Progress::expected);
}

TEST_CASE("live, pilot and simulated participants are evened out separately", "[store]") {
  Lab lab;
  CHECK(lab.session("A", 0) == 0);
  lab.mode = RunMode::simulated;
  CHECK(lab.session("S", 1) == 1);
  lab.mode = RunMode::live;
  CHECK(lab.session("B", 2) == 2);
  CHECK(lab.session("C", 3) == 3);
  CHECK(lab.session("D", 4) == 5);  // nobody live is in row 1, and place 1 is taken
}

TEST_CASE("two codes of one person count once", "[store]") {
  Lab lab;
  CHECK(lab.session("A", 0) == 0);
  lab.session("B", 1);
  CHECK(lab.session("C", 2) == 2);
  CHECK(lab.session("D", 3) == 3);
  join(lab.db, "A", "B");
  CHECK(lab.session("A", 4) == 0);  // the place of the newest session counts, so nobody is in row 1
  CHECK(lab.session("E", 5) == 5);
  CHECK(lab.session("F", 6) == 4);
}

TEST_CASE("a clock that is behind replaces nobody, and one that is ahead replaces too early", "[store]") {
  const Lab lab;
  lab.session("A", 1000);
  CHECK(lab.leaves("B", 1001) == 1);
  CHECK(lab.session("C", -400000) == 2);  // 1980
  CHECK(lab.session("D", 5000) == 3);
  CHECK(lab.session("E", 5001) == 5);  // B is a dropout
  CHECK(lab.session("B", 1010) == 1);  // the clock was set right: B comes back, and the rows even out
  CHECK(lab.session("F", 1011) == 4);
  CHECK(lab.session("G", 1012) == 6);
}

TEST_CASE("of the leased places, the next participant gets one in the row with the fewest", "[store]") {
  const Lab lab;
  CHECK(lab.leaves("A", 0) == 0);
  CHECK(lab.session("B", 1) == 1);
  set_leased_places(lab.db, sample::start().protocol_id, {4, 5, 6, 8, 9});
  CHECK(lab.session("C", 2) == 6);   // nobody is in row 2
  CHECK(lab.session("D", 3) == 4);   // rows 0, 1 and 2 have one: the lowest place
  CHECK(lab.session("E", 60) == 5);  // A is gone: rows 0 and 1 have one
  CHECK(lab.session("F", 61) == 8);
  CHECK(lab.session("G", 62) == 9);
  CHECK(sample::failure([&] { lab.session("H", 63); }).first == ErrorKind::refused);
  CHECK(lab.session("A", 64) == 0);
}

TEST_CASE("the place follows from rows and places, as trying every place finds it", "[store]") {
  std::mt19937 random(46);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  int tried = 0, refused = 0;
  for (int run = 0; run < 2000; ++run) {
    const int rows = 1 + below(6);
    std::set<std::int64_t> used, leased;
    for (int i = below(12); i > 0; --i) used.insert(below(20));
    for (int i = below(8); i > 0; --i) leased.insert(below(20));
    std::map<std::int64_t, std::int64_t> held;
    for (int i = below(12); i > 0; --i) ++held[below(rows)];
    const bool shared = below(2) == 1;
    // all candidates, each with how many are in its row, best first
    std::vector<std::pair<std::int64_t, std::int64_t>> all;
    for (std::int64_t place = 0; place < 20 * 7; ++place)
      if (used.count(place) == 0 && (!shared || leased.count(place) > 0))
        all.emplace_back(held.count(place % rows) > 0 ? held.at(place % rows) : 0, place);
    std::sort(all.begin(), all.end());
    const auto place = choose_place(
        {used.begin(), used.end()},
        shared ? std::optional(std::vector(leased.begin(), leased.end())) : std::nullopt, held, rows);
    INFO("run " << run);
    REQUIRE(place == (all.empty() ? std::nullopt : std::optional(all.front().second)));
    ++tried;
    refused += !place;
  }
  CHECK(refused > 10);
  CHECK(refused < tried / 2);
}

namespace {

enum class Rule { lowest, fewest };
enum class Returning { never, some };

struct Study {
  int difference = 0;  ///< completed participants of the fullest row less those of the emptiest one
  int participants = 0;
};

/// A study with two sessions, a week apart. A participant comes each day until 24 have completed or are
/// expected, one in five drops out after the first session, and if `returning`, one in four of these comes
/// back two days after being given up. places.py is the same study, written without this program.
Study study(Rule rule, Returning returning, std::mt19937& random) {
  struct Person {
    std::int64_t place;
    int first, second;
  };
  constexpr int never = std::numeric_limits<int>::max(), rows = 4, expected_h = 14 * 24;
  std::vector<Person> people;
  std::uniform_real_distribution<> share(0, 1);
  for (int hour = 24;; hour += 24) {
    std::map<std::int64_t, std::int64_t> held, done;
    int completed = 0, waiting = 0;
    std::vector<std::int64_t> used;
    for (const auto& person : people) {
      used.push_back(person.place);
      if (person.second <= hour)
        ++completed, ++done[person.place % rows], ++held[person.place % rows];
      else if (hour - person.first < expected_h)
        ++waiting, ++held[person.place % rows];
    }
    if (completed >= 24 && waiting == 0) {
      int most = 0, least = never;
      for (int row = 0; row < rows; ++row) {
        most = std::max(most, static_cast<int>(done[row]));
        least = std::min(least, static_cast<int>(done[row]));
      }
      return {most - least, static_cast<int>(people.size())};
    }
    if (completed + waiting >= 24) continue;
    std::sort(used.begin(), used.end());
    const auto place = rule == Rule::fewest ? choose_place(used, std::nullopt, held, rows)
                                            : choose_place(used, std::nullopt, {}, 1);
    const bool leaves = share(random) < 0.2;
    const bool back = leaves && returning == Returning::some && share(random) < 0.25;
    people.push_back({*place, hour, leaves && !back ? never : hour + (leaves ? expected_h + 48 : 7 * 24)});
  }
}

/// What places.py gives for 20 000 studies.
struct Figures {
  Rule rule;
  Returning returning;
  double even, mean, sd;
};

}  // namespace

TEST_CASE("in 1000 studies with 20 % dropouts, the rows have equally many who completed", "[store]") {
  constexpr int studies = 1000;
  const auto figures = GENERATE(Figures{Rule::lowest, Returning::never, 0.0813, 2.3718, 1.090},
                                Figures{Rule::fewest, Returning::never, 1, 0, 0},
                                Figures{Rule::lowest, Returning::some, 0.0879, 2.0723, 0.990},
                                Figures{Rule::fewest, Returning::some, 0.5736, 0.6390, 0.812});
  std::mt19937 random(1);
  double even = 0, sum = 0;
  for (int i = 0; i < studies; ++i) {
    const auto [difference, participants] = study(figures.rule, figures.returning, random);
    even += difference == 0;
    sum += difference;
  }
  CAPTURE(even / studies, sum / studies, figures.even, figures.mean);
  CHECK(std::abs(even / studies - figures.even) <=
        4 * std::sqrt(figures.even * (1 - figures.even) / studies));
  CHECK(std::abs(sum / studies - figures.mean) <= 4 * figures.sd / std::sqrt(studies));
}

TEST_CASE("a database evens out a study with dropouts", "[store]") {
  std::mt19937 random(20261130);
  for (int run = 0; run < 3; ++run) {
    Lab lab;
    std::map<int, int> completed;
    int done = 0, hour = 0, people = 0;
    // who drops out is replaced after two days, so the study waits two days before it counts
    while (done < 12) {
      const auto code = "P" + std::to_string(++people);
      const bool leaves = random() % 5 == 0;
      const int place = leaves ? lab.leaves(code, hour) : lab.session(code, hour);
      if (!leaves) ++done, ++completed[place % 4];
      hour += leaves ? 49 : 1;
    }
    INFO("participants " << people);
    for (int row = 0; row < 4; ++row) CHECK(completed[row] == 3);
    CHECK(verify(lab.db).good());
  }
}

TEST_CASE("an enrolment that is killed at any moment loses no place and gives none twice", "[store]") {
  const Lab lab;
  std::mt19937 random(3);
  int acknowledged = 0;
  for (int kills = 0; kills < 40; ++kills) {
    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    const auto child = ::fork();
    if (child == 0) {
      ::close(ends[0]);
      try {
        for (int i = 0;; ++i) {
          SessionLog::begin(lab.db, lab.start(std::to_string(kills) + "-" + std::to_string(i)), lab.at(0));
          if (::write(ends[1], &i, sizeof i) != sizeof i) ::_exit(3);
        }
      } catch (...) {
        ::_exit(2);
      }
    }
    ::close(ends[1]);
    // some are killed while they enrol the first participant, the others some participants later
    const int wanted = std::uniform_int_distribution<>(-1, 2)(random);
    int index = 0;
    for (int seen = 0; seen < wanted && ::read(ends[0], &index, sizeof index) == sizeof index; ++seen)
      ++acknowledged;
    ::usleep(std::uniform_int_distribution<useconds_t>(0, 8000)(random));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));
    while (::read(ends[0], &index, sizeof index) == sizeof index) ++acknowledged;
    ::close(ends[0]);
  }
  const int last = lab.session("last", 1);
  CHECK(acknowledged > 10);
  CHECK(last >= acknowledged);
  const auto sessions = list_sessions(lab.db);
  CHECK(static_cast<int>(sessions.size()) == last + 1);
  std::set<int> places;
  for (const auto& session : sessions) places.insert(session.sequence_index);
  // all of them are expected, so the places are 0, 1, 2 and so on, and each is there once
  CHECK(places.size() == sessions.size());
  CHECK(*places.rbegin() == last);
  CHECK(verify(lab.db).good());
}

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <random>

#include "station/store/read.hpp"
#include "tests/store/kept_signals.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

enum class Acknowledge { after_commit, before_commit };

// a writer that acknowledges trials before it commits them (the negative control) commits this many at once
constexpr std::size_t kHeldBack = 8;

/// Continues the interrupted session of a database, or begins a new one, and appends trials for ever.
/// Acknowledges each trial by writing its index to the pipe.
[[noreturn]] void write_for_ever(const std::string& db, int pipe, Acknowledge when) {
  const auto interrupted = std::filesystem::exists(db) ? interrupted_session(db) : std::nullopt;
  auto log = interrupted ? SessionLog::resume(db, interrupted->session.session_id, sample::segment("resume"))
                         : SessionLog::begin(db, sample::start(), sample::segment());
  log.begin_block(sample::block());
  std::vector<TrialRow> held;
  for (int i = log.session().trials;; ++i) {
    held.push_back(sample::answered(i));
    if (when == Acknowledge::after_commit || held.size() == kHeldBack) {
      for (const auto& trial : held) {
        log.presented(trial.trial_index, 1);
        log.append(trial);
      }
      held.clear();
    }
    if (::write(pipe, &i, sizeof i) != sizeof i) ::_exit(3);
  }
}

struct Toll {
  int kills = 0, acknowledged = 0, lost = 0, damaged = 0, repeated = 0, wrong_signals = 0;
};

/// Kills a writing process at a random moment, then checks the database.
void kill_once(const std::string& db, Acknowledge when, std::mt19937& random, Toll& toll) {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const auto child = ::fork();
  if (child == 0) {
    ::close(ends[0]);
    try {
      write_for_ever(db, ends[1], when);
    } catch (...) {
      ::_exit(2);
    }
  }
  ::close(ends[1]);
  // On a machine of any speed, half of the processes are killed while they begin, and the others after some
  // trials.
  const int wanted = std::uniform_int_distribution<>(-5, 5)(random);
  int last = -1, index = 0;
  for (int seen = 0; seen < wanted && ::read(ends[0], &index, sizeof index) == sizeof index; ++seen) {
    last = index;
    ++toll.acknowledged;
  }
  ::usleep(std::uniform_int_distribution<useconds_t>(0, wanted > 0 ? 500 : 8000)(random));
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));  // the process must not have ended by itself
  while (::read(ends[0], &index, sizeof index) == sizeof index) {
    last = index;
    ++toll.acknowledged;
  }
  ::close(ends[0]);
  ++toll.kills;
  if (!std::filesystem::exists(db)) {
    toll.lost += last + 1;
    return;
  }
  auto raw = sample::raw(db);
  if (raw.text("PRAGMA integrity_check") != "ok") ++toll.damaged;
  const auto trials = raw.integer("SELECT count(*) FROM trial");
  toll.wrong_signals += sample::wrong_signals(raw, last + 1);
  toll.lost += trials < last + 1 ? last + 1 - static_cast<int>(trials) : 0;
  toll.repeated += trials != raw.integer("SELECT coalesce(max(trial_index), -1) + 1 FROM trial") ? 1 : 0;
}

Toll kill_many(int kills, Acknowledge when) {
  Toll toll;
  std::mt19937 random(7);
  for (int round = 0; toll.kills < kills; ++round) {
    // Start with a new database now and then, so that processes are also killed while they create one.
    TemporaryFolder folder;
    for (int i = 0; i < 25 && toll.kills < kills; ++i) kill_once(folder / "a.sqlite", when, random, toll);
  }
  return toll;
}

}  // namespace

TEST_CASE(
    "hundreds of writers killed at random moments lose no trial that they acknowledged, and no sample of one",
    "[store]") {
  const auto toll = kill_many(300, Acknowledge::after_commit);
  CHECK(toll.kills == 300);
  CHECK(toll.acknowledged > 300);
  CHECK(toll.lost == 0);
  CHECK(toll.damaged == 0);
  CHECK(toll.repeated == 0);
  CHECK(toll.wrong_signals == 0);
}

TEST_CASE("negative control: a writer that acknowledges before it commits loses trials", "[store]") {
  CHECK(kill_many(30, Acknowledge::before_commit).lost > 0);
}

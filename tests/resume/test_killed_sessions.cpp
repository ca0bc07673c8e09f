#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <optional>
#include <random>

#include "station/core/read_file.hpp"
#include "station/session/prepare.hpp"
#include "station/store/read.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"

using namespace turnpoint;

namespace {

/// TURNPOINT_KILLS=1000 makes a long run with this number of kills, which also includes an adaptive protocol.
const char* const kLong = std::getenv("TURNPOINT_KILLS");
/// TURNPOINT_KILLS_PART=3/8 runs only every eighth protocol, beginning with the third.
const char* const kPart = std::getenv("TURNPOINT_KILLS_PART");

/// A shipped protocol with some texts replaced, and the number of kills if TURNPOINT_KILLS is not set.
struct Case {
  std::string file;
  std::vector<std::pair<std::string, std::string>> edits = {};
  int kills = 2;
  std::optional<int> planned_session = {};  ///< number of the session, if the protocol plans several
};

int kills_wanted(const Case& wanted) { return kLong != nullptr ? std::atoi(kLong) : wanted.kills; }

/// Protocols with all kinds of task and procedure, most of them shortened to few trials.
std::vector<Case> protocols() {
  const std::pair<std::string, std::string> three_each{"repeats = 15", "repeats = 3"};
  const std::pair<std::string, std::string> few{"repeats = 8", "repeats = 3"};
  const std::pair<std::string, std::string> twelve{"stop = { trials = 70", "stop = { trials = 12"};
  const std::pair<std::string, std::string> at_least{"min_trials = 30", "min_trials = 12"};
  return {{"demo.toml", {}, 10},
          {"magnitude-standard.toml", {}, 10},
          {"friction-confidence.toml", {}, 10},
          {"friction-identification.toml", {three_each}},
          {"friction-3ifc.toml", {twelve, at_least}},
          {"friction-4ifc.toml",
           {{"stop = { trials = 48 }", "stop = { trials = 12 }"},
            {"break_after = { trials = 24", "break_after = { trials = 6"},
            {"picture = \"pictures/slide.png\"\n", ""}}},
          {"friction-time-limit.toml",
           {{"stop = { trials = 60 }", "stop = { trials = 8 }"},
            {"trials = 30 ", "trials = 4 "},
            {"break_after = { trials = 42", "break_after = { trials = 6"},
            {"repeats = 14", "repeats = 2"}},
           2,
           1},
          {"friction-abx.toml", {three_each}},
          {"friction-abx.toml", {three_each, {"kind = \"abx\"", "kind = \"match-to-sample\""}}},
          {"smoothness-points.toml", {few}},
          {"smoothness-line.toml", {few}},
          {"magnitude-free.toml", {few}},
          {"limits-boundary.toml", {{"series = 12", "series = 4"}}},
          {"limits-boundary.toml",
           {{"series = 12", "series = 4"},
            {"n_change = 1", "n_change = 2"},
            {"[22.0, 26.0, 30.0]", "{ uniform = [20.0, 30.0] }"}}},
          {"response-signal.toml", {{"repeats = 84", "repeats = 3"}, {"trials = 28", "trials = 4"}}},
          {"response-signal-buzz.toml", {{"repeats = 84", "repeats = 3"}, {"trials = 28", "trials = 4"}}},
          {"response-signal-flash.toml", {{"repeats = 84", "repeats = 3"}, {"trials = 28", "trials = 4"}}},
          {"friction-rating.toml", {{"repeats = 20", "repeats = 2"}}},
          {"friction-weber.toml", {{"stop = { trials = 40 }", "stop = { trials = 6 }"}}},
          {"friction-weber.toml",
           {{"stop = { trials = 40 }", "stop = { trials = 6 }"},
            {"draw = \"uniform\"", "draw = { normal = { mean = 185.0, sd = 2.0 } }"}}},
          {"friction-weber.toml",
           {{"stop = { trials = 40 }", "stop = { trials = 6 }"},
            {"range = [180.0, 190.0]\ndraw = \"uniform\"",
             "levels = [180.0, 183.0, 185.0, 188.0, 190.0]\ndraw = \"without-repetition\""}}},
          {"friction-boundary-2d.toml", {{"stop = { trials = 96 }", "stop = { trials = 12 }"}}},
          {"friction-yes-no.toml", {{"stop = { trials = 100 }", "stop = { trials = 12 }"}}},
          {"friction-detection.toml", {{"repeats = 20", "repeats = 2"}}},
          {"friction-training.toml", {{"stop = { trials = 60 }", "stop = { trials = 8 }"}}, 2, 3},
          {"speed-accuracy.toml",
           {{"[protocol]", "[sessions]\ncount = 2\n\n[protocol]"}, {"repeats = 14", "repeats = 2"}},
           2,
           2},
          {"boundary-adjustment.toml", {{"repeats = 9", "repeats = 4"}}},
          {"friction-pairs.toml", {{"repeats = 4 ", "repeats = 1 "}, {"-18.0, -14.0, ", ""}}},
          {"friction-triads.toml", {{"repeats = 3", "repeats = 1"}, {"-18.0, -14.0, ", ""}}}};
}

/// The protocols to kill in this run: all, or those of TURNPOINT_KILLS_PART.
std::vector<Case> chosen() {
  auto all = protocols();
  if (kLong != nullptr) all.push_back({"boundary-adaptive.toml"});
  if (kPart == nullptr) return all;
  std::size_t part = 0, parts = 0;
  REQUIRE(std::sscanf(kPart, "%zu/%zu", &part, &parts) == 2);
  REQUIRE((part >= 1 && part <= parts && parts <= all.size()));
  std::vector<Case> chosen;
  for (auto i = part - 1; i < all.size(); i += parts) chosen.push_back(std::move(all[i]));
  return chosen;
}

/// Writes the protocol with its edits into the folder, and returns its path.
std::string written(const Case& wanted, const TemporaryFolder& folder) {
  auto source = core::read_file(std::string(TURNPOINT_SOURCE_DIR) + "/protocols/" + wanted.file);
  for (const auto& [from, to] : wanted.edits) {
    REQUIRE(source.find(from) != std::string::npos);
    source.replace(source.find(from), from.size(), to);
  }
  const auto path = folder / wanted.file;
  std::ofstream(path) << source;
  return path;
}

session::Setup prepared(const std::string& protocol, const Case& wanted, const std::string& db) {
  auto request = simulated_run(protocol, db, 42);
  request.headless = true;
  request.planned_session = wanted.planned_session;
  return session::prepare(request);
}

/// Begins a session, or continues the interrupted one, and runs it to its end.
void run_to_end(session::Setup setup) {
  if (std::filesystem::exists(setup.database))
    if (const auto interrupted = store::interrupted_session(setup.database))
      setup.resume_session = interrupted->session.session_id;
  session::Inputs inputs;
  session::run(setup, nullptr, inputs);
}

/// Runs the session in a child process and kills it. Returns true if it was killed before the session's end.
bool killed_on_the_way(const session::Setup& setup, useconds_t after_us) {
  const auto child = ::fork();
  if (child == 0) {
    int status = 0;
    try {
      run_to_end(setup);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s\n", error.what());
      status = 1;
    }
    ::_exit(status);
  }
  ::usleep(after_us);
  ::kill(child, SIGKILL);
  int status = 0;
  ::waitpid(child, &status, 0);
  REQUIRE((WIFSIGNALED(status) || WEXITSTATUS(status) == 0));
  return WIFSIGNALED(status);
}

std::vector<core::TrialRow> trials_of(const std::string& db, const std::string& id) {
  std::vector<core::TrialRow> trials;
  for (const auto& block : store::read_session(db, id).blocks)
    for (const auto& trial : block.trials)
      if (trial.type != core::TrialType::warmup) trials.push_back(trial);
  return trials;
}

/// Compares what a trial presented and its result, but not its times.
void check_equal(const core::TrialRow& a, const core::TrialRow& b) {
  CHECK(a.trial_in_block == b.trial_in_block);
  CHECK(a.type == b.type);
  CHECK(a.procedure == b.procedure);
  CHECK(a.level == b.level);
  CHECK(a.factors == b.factors);
  CHECK(a.correct_response == b.correct_response);
  CHECK(a.given.response == b.given.response);
  CHECK(a.given.confidence == b.given.confidence);
  CHECK(a.outcome == b.outcome);
  REQUIRE(a.timing.response_time_s.has_value() == b.timing.response_time_s.has_value());
  // Times may differ by up to one frame.
  if (a.timing.response_time_s)
    CHECK(*a.timing.response_time_s == Approx(*b.timing.response_time_s).margin(1e-5));
  CHECK(a.learned.state_hash == b.learned.state_hash);
  REQUIRE(a.tones.size() == b.tones.size());
  for (std::size_t i = 0; i < a.tones.size(); ++i) {
    CHECK(a.tones[i].frequency_Hz == b.tones[i].frequency_Hz);
    CHECK(a.tones[i].amplitude_um == b.tones[i].amplitude_um);
  }
}

void check_killed(const Case& wanted) {
  TemporaryFolder folder;
  const auto protocol = written(wanted, folder);
  INFO(wanted.file << (wanted.edits.empty() ? "" : ", " + wanted.edits.back().second));
  const auto whole = folder / "whole.sqlite";
  auto setup = prepared(protocol, wanted, whole);
  const auto start = std::chrono::steady_clock::now();
  run_to_end(setup);
  const std::chrono::duration<double, std::micro> whole_us = std::chrono::steady_clock::now() - start;
  const auto expected = trials_of(whole, store::list_sessions(whole).front().session_id);
  REQUIRE(!expected.empty());
  std::mt19937 random(3);
  // Kill at a random moment of the whole session, so that its beginning, its trials and its end are all
  // interrupted sometimes.
  std::uniform_int_distribution<useconds_t> moment(0, static_cast<useconds_t>(1.2 * whole_us.count()));
  int kills = 0, finished = 0, resumed = 0;
  // If the machine was busy when the uninterrupted session was timed, most kills come too late. Then try more
  // often.
  while (kills < kills_wanted(wanted) || finished == 0 || (resumed == 0 && finished < 100)) {
    const auto db = folder / ("broken" + std::to_string(finished) + ".sqlite");
    setup.database = db;
    while (killed_on_the_way(setup, moment(random))) ++kills;
    ++finished;
    auto raw = sample::raw(db);
    CHECK(raw.text("PRAGMA integrity_check") == "ok");
    for (const auto& session : store::list_sessions(db)) {
      if (session.status == core::SessionStatus::abandoned) continue;
      CHECK(session.status == core::SessionStatus::completed);
      resumed += session.segments > 1 ? 1 : 0;
      const auto trials = trials_of(db, session.session_id);
      REQUIRE(trials.size() == expected.size());
      for (std::size_t i = 0; i < trials.size(); ++i) check_equal(trials[i], expected[i]);
    }
    std::filesystem::remove(db);
  }
  INFO(kills << " kills, " << finished << " sessions finished, " << resumed << " of them resumed");
  CHECK(resumed > 0);
}

}  // namespace

TEST_CASE(
    "a session of any task that is killed at random moments and resumed equals one that was never "
    "interrupted, "
    "trial by trial",
    "[resume]") {
  check_killed(GENERATE(from_range(chosen())));
}

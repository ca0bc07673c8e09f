#include <signal.h>

#include <cstring>
#include <filesystem>

#include "station/store/read.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/child.hpp"

using namespace turnpoint;

namespace {

/// Longest time to wait for the process, even on a busy machine. It also ends a test in which the process
/// ignores the request to stop.
constexpr int kPatience_ms = 20000;
/// Longest time allowed from the signal to the end of the process. A service manager kills the process after
/// 5 s.
constexpr int kPrompt_ms = 1000;
/// Longest time allowed for a whole simulated session, even with a sanitizer.
constexpr int kWhole_ms = 120000;

std::vector<std::string> run(const std::string& protocol, const std::string& database,
                             const std::vector<std::string>& how) {
  const std::string source = TURNPOINT_SOURCE_DIR;
  std::vector<std::string> command = {TURNPOINT,
                                      "run",
                                      source + "/protocols/" + protocol,
                                      "--rig",
                                      source + "/tests/support/thin_plate.toml",
                                      "--participant",
                                      "P01",
                                      "--seed",
                                      "42",
                                      "--db",
                                      database};
  command.insert(command.end(), how.begin(), how.end());
  return command;
}

std::vector<std::string> by_buttons(const std::string& database) {
  return run("demo.toml", database, {"--buttons-only"});
}

/// A session of 137 trials, which takes more than a second even on a fast machine.
std::vector<std::string> simulated(const std::string& database) {
  return run("boundary-adaptive.toml", database, {"--headless", "--observer", "sim"});
}

std::vector<std::string> resume(const std::string& database) {
  return {TURNPOINT, "resume", "--db", database, "--headless"};
}

/// Waits for the first stimulus of a session in which a person, who uses the buttons, must confirm the
/// instructions.
void begin_first_stimulus(Child& child) {
  REQUIRE(child.says("instructions", kPatience_ms));
  child.type("next");
  REQUIRE(child.says("stimulus", kPatience_ms));
}

/// Waits until a simulated session has stored this many trials.
void make_trials(Child& child, const std::string& database, int wanted) {
  for (int waited_ms = 0; waited_ms < kPatience_ms; ++waited_ms) {
    if (std::filesystem::exists(database)) {
      const auto sessions = store::list_sessions(database);
      if (!sessions.empty() && sessions[0].trials >= wanted) return;
    }
    REQUIRE_FALSE(child.ends_within(1));
  }
  FAIL("fewer than " << wanted << " trials within " << kPatience_ms << " ms");
}

void until_first_signal_is_taken(Child& child, int signal) {
  for (int waited_ms = 0; child.handles(signal) && waited_ms < kPatience_ms; ++waited_ms)
    REQUIRE_FALSE(child.ends_within(1));
}

store::SessionRecord only_session(const std::string& database) {
  const auto sessions = store::list_sessions(database);
  REQUIRE(sessions.size() == 1);
  return sessions[0];
}

/// The trials of the session, without the warm-up trials that follow a resume.
std::vector<core::TrialRow> trials_of(const std::string& database) {
  std::vector<core::TrialRow> trials;
  for (const auto& block : store::read_session(database, only_session(database).session_id).blocks)
    for (const auto& trial : block.trials)
      if (trial.type != core::TrialType::warmup) trials.push_back(trial);
  return trials;
}

std::string reason_for(int signal) {
  return std::string("the program was stopped by a signal (SIG") + ::sigabbrev_np(signal) + ")";
}

/// Checks what the process has printed about a session that `signal` ended, and what its database contains.
void check_stopped(const Child& child, int signal, const store::SessionRecord& session) {
  CHECK(child.outcome() == 1);
  CHECK(child.said().find("interrupted: " + reason_for(signal)) != std::string::npos);
  CHECK(child.said().find("turnpoint resume --db ") != std::string::npos);
  CHECK(child.said().find("--session " + session.session_id) != std::string::npos);
  CHECK(session.status == core::SessionStatus::interrupted);
  CHECK(session.status_reason == reason_for(signal));
}

}  // namespace

TEST_CASE("a stop signal during a stimulus ends a session with buttons as the operator's stop does",
          "[stop]") {
  const TemporaryFolder folder;
  const auto database = folder / "db";
  const int signal = GENERATE(SIGTERM, SIGINT, SIGHUP);
  Child child(by_buttons(database));
  begin_first_stimulus(child);
  child.signal(signal);
  REQUIRE(child.ends_within(kPrompt_ms));
  CAPTURE(child.said());
  check_stopped(child, signal, only_session(database));
  const auto trials = trials_of(database);
  REQUIRE(trials.size() == 1);
  CHECK(trials[0].outcome == core::Outcome::aborted);
  // The stimulus was ramped down before the program ended, so its event is stored.
  const auto stored = store::read_session(database, only_session(database).session_id);
  int stimuli = 0;
  for (const auto& event : stored.events) stimuli += event.kind == "stimulus" ? 1 : 0;
  CHECK(stimuli == 1);

  Child again(resume(database));
  begin_first_stimulus(again);
  again.signal(SIGTERM);
  REQUIRE(again.ends_within(kPrompt_ms));
  check_stopped(again, SIGTERM, only_session(database));
  CHECK(again.said().find(" --headless\n") != std::string::npos);
  CHECK(only_session(database).segments == 2);
  CHECK(trials_of(database).size() == 2);
}

TEST_CASE("a simulated session that is stopped by signals and resumed gives the trials of an unbroken one",
          "[stop]") {
  const TemporaryFolder folder;
  const auto database = folder / "db";
  Child child(simulated(database));
  make_trials(child, database, 3);
  child.signal(SIGTERM);
  REQUIRE(child.ends_within(kPrompt_ms));
  CAPTURE(child.said());
  check_stopped(child, SIGTERM, only_session(database));

  Child again(resume(database));
  make_trials(again, database, only_session(database).trials + 3);
  again.signal(SIGINT);
  REQUIRE(again.ends_within(kPrompt_ms));
  CAPTURE(again.said());
  check_stopped(again, SIGINT, only_session(database));
  const auto before = trials_of(database).size();

  Child to_the_end(resume(database));
  REQUIRE(to_the_end.ends_within(kWhole_ms));
  CHECK(to_the_end.outcome() == 0);
  CHECK(only_session(database).status == core::SessionStatus::completed);
  CHECK(only_session(database).segments == 3);
  Child unbroken(simulated(folder / "unbroken"));
  REQUIRE(unbroken.ends_within(kWhole_ms));
  const auto trials = trials_of(database), expected = trials_of(folder / "unbroken");
  CHECK(before < expected.size());
  REQUIRE(trials.size() == expected.size());
  for (std::size_t i = 0; i < trials.size(); ++i) {
    CHECK(trials[i].outcome == expected[i].outcome);
    CHECK(trials[i].level == expected[i].level);
    CHECK(trials[i].given.response == expected[i].given.response);
    CHECK(trials[i].learned.state_hash == expected[i].learned.state_hash);
  }
}

TEST_CASE("a second signal ends a session at once if its ending hangs", "[stop]") {
  const TemporaryFolder folder;
  const auto database = folder / "db";
  const int signal = GENERATE(SIGTERM, SIGINT);
  Child child(by_buttons(database));
  begin_first_stimulus(child);
  auto held = sample::raw(database);
  held.execute("BEGIN IMMEDIATE");  // the session cannot write until this transaction ends
  REQUIRE(child.handles(signal));
  child.signal(signal);
  until_first_signal_is_taken(child, signal);
  REQUIRE_FALSE(child.ends_within(100));
  child.signal(signal);
  REQUIRE(child.ends_within(kPrompt_ms));
  CAPTURE(child.said());
  CHECK(child.outcome() == -signal);
  held.execute("ROLLBACK");
  CHECK(only_session(database).status == core::SessionStatus::running);
}

TEST_CASE("a session continues after a signal that the starting program has set to be ignored", "[stop]") {
  const TemporaryFolder folder;
  const auto database = folder / "db";
  const auto before = ::signal(SIGHUP, SIG_IGN);
  Child child(simulated(database));
  ::signal(SIGHUP, before);
  make_trials(child, database, 3);
  CHECK_FALSE(child.handles(SIGHUP));
  child.signal(SIGHUP);
  make_trials(child, database, only_session(database).trials + 3);
  child.signal(SIGTERM);
  REQUIRE(child.ends_within(kPrompt_ms));
  CAPTURE(child.said());
  check_stopped(child, SIGTERM, only_session(database));
}

TEST_CASE("a session ends cleanly even if the program that reads its messages was ended too", "[stop]") {
  const TemporaryFolder folder;
  const auto database = folder / "db";
  Child child(by_buttons(database));
  begin_first_stimulus(child);
  child.stop_listening();
  child.signal(SIGINT);
  REQUIRE(child.ends_within(kPrompt_ms));
  CHECK(child.outcome() == 1);
  CHECK(only_session(database).status == core::SessionStatus::interrupted);
  CHECK(only_session(database).status_reason == reason_for(SIGINT));
}

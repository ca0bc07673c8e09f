#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

#include "station/session/prepare.hpp"
#include "station/session/resume.hpp"
#include "station/session/session.hpp"
#include "station/store/read.hpp"
#include "tests/session/screen.hpp"
#include "tests/session/stored_trials.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/simulated_run.hpp"
#include "tests/support/stochastic_approximation.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
namespace fs = std::filesystem;

namespace {

const std::string kSource = TURNPOINT_SOURCE_DIR;

session::RunRequest request_for(const std::string& protocol, const std::string& database) {
  return simulated_run(kSource + "/protocols/" + protocol + ".toml", database, 20261121);
}

session::Summary run(const session::RunRequest& request) {
  session::Inputs inputs;
  return session::run(session::prepare(request), nullptr, inputs);
}

/// Records the level of each trial that begins or ends.
struct Watch : session::Monitor {
  std::vector<std::optional<double>> announced, ended;
  void trial_begins(const trial::TrialSpec& spec, const protocol::Block&,
                    const session::PlanAhead::Plans&) override {
    announced.push_back(spec.level);
  }
  void trial_ended(const trial::TrialSpec&, const core::TrialRow& row) override {
    ended.push_back(row.level);
  }
};

}  // namespace

TEST_CASE("the demo protocol runs and its trials are stored in SQLite", "[session]") {
  const TemporaryFolder folder;
  const auto summary = run(request_for("demo", folder / "a.sqlite"));
  CHECK(summary.status == core::SessionStatus::completed);
  const auto trials = trials_of(folder / "a.sqlite", summary.session_id);
  REQUIRE(static_cast<int>(trials.size()) == summary.trials);
  for (const auto& trial : trials) {
    CHECK(trial.outcome == core::Outcome::answered);
    CHECK(*trial.timing.response_time_s > 0);
    CHECK(trial.timing.response_time_quality == "simulated");
    CHECK(trial.presented.frequency_Hz.has_value());
    REQUIRE(trial.tones.size() == 1);
    CHECK(trial.tones[0].model.size() > 0);
  }
  const auto sessions = store::list_sessions(folder / "a.sqlite");
  REQUIRE(sessions.size() == 1);
  CHECK(sessions[0].start.run_mode == core::RunMode::simulated);
}

void runs_to_its_end(const std::string& protocol) {
  const TemporaryFolder folder;
  INFO(protocol);
  const auto summary = run(request_for(protocol, folder / "b.sqlite"));
  CHECK(summary.status == core::SessionStatus::completed);
  CHECK(summary.trials > 20);
}

TEST_CASE("the shipped boundary protocol of one tone runs to its end", "[session]") {
  runs_to_its_end("boundary-constant");
}
TEST_CASE("the shipped adaptive boundary protocol runs to its end", "[session]") {
  runs_to_its_end("boundary-adaptive");
}
TEST_CASE("the shipped QUEST+ protocol runs to its end", "[session]") { runs_to_its_end("friction-2ifc"); }
TEST_CASE("the shipped same-different protocol runs to its end", "[session]") {
  runs_to_its_end("friction-same-different");
}
TEST_CASE("the shipped staircase protocol runs to its end", "[session]") {
  runs_to_its_end("friction-staircase");
}
TEST_CASE("the shipped control condition without touch runs to its end", "[session]") {
  runs_to_its_end("no-touch-control");
}
TEST_CASE("the shipped speed and accuracy protocol runs to its end", "[session]") {
  runs_to_its_end("speed-accuracy");
}
TEST_CASE("the shipped oddity protocol runs to its end", "[session]") { runs_to_its_end("two-spots-oddity"); }

TEST_CASE("a simulated observer that can never answer in time does not go on for ever", "[session]") {
  TemporaryFolder folder;
  auto request = request_for("friction-rating", folder / "a.sqlite");
  std::ifstream shipped(request.protocol);
  std::string text{std::istreambuf_iterator<char>(shipped), {}};
  const auto deadline = text.find("deadline_s = 4.0");
  REQUIRE(deadline != std::string::npos);
  text.replace(deadline, 16, "deadline_s = 0.05");
  request.protocol = folder / "hasty.toml";
  std::ofstream(request.protocol) << text;
  const auto summary = run(request);
  CHECK(summary.status == core::SessionStatus::interrupted);
  CHECK(summary.reason == "the simulated observer left 1000 trials in a row unanswered");
  CHECK(summary.trials == 1000);
}

TEST_CASE("the same seed gives the same trials and answers", "[session]") {
  const TemporaryFolder folder;
  const auto first = run(request_for("demo", folder / "a.sqlite")),
             second = run(request_for("demo", folder / "b.sqlite"));
  const auto a = trials_of(folder / "a.sqlite", first.session_id),
             b = trials_of(folder / "b.sqlite", second.session_id);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].level == b[i].level);
    CHECK(a[i].given.response == b[i].given.response);
    CHECK(a[i].timing.response_time_s == b[i].timing.response_time_s);
    CHECK(a[i].learned.state_hash == b[i].learned.state_hash);
  }
}

TEST_CASE(
    "a session cut at any page continues with the same trial that the uninterrupted session would have shown",
    "[session]") {
  const TemporaryFolder folder;
  const auto whole = run(request_for("demo", folder / "whole.sqlite"));
  const auto expected = trials_of(folder / "whole.sqlite", whole.session_id);
  for (int page = 8; page < 40; page += 6) {
    INFO("cut at page " << page);
    const auto database = folder / ("cut" + std::to_string(page) + ".sqlite");
    Screen cut(page);
    session::Inputs inputs;
    auto setup = session::prepare(request_for("demo", database));
    setup.protocol.resume.warmup = 0;
    CHECK_THROWS_AS(session::run(setup, &cut, inputs), std::runtime_error);
    std::ostringstream messages;
    auto resumed = session::prepare_resume({database, "", "resume", true}, messages);
    REQUIRE(resumed.has_value());
    resumed->protocol.resume.warmup = 0;
    const auto summary = session::run(*resumed, nullptr, inputs);
    CHECK(summary.status == core::SessionStatus::completed);
    const auto trials = trials_of(database, summary.session_id);
    REQUIRE(trials.size() == expected.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      CHECK(trials[i].level == expected[i].level);
      CHECK(trials[i].factors == expected[i].factors);
      CHECK(trials[i].given.response == expected[i].given.response);
      CHECK(trials[i].learned.state_hash == expected[i].learned.state_hash);
    }
  }
}

TEST_CASE(
    "an accelerated stochastic approximation that is interrupted in a track continues at the same level",
    "[session]") {
  const TemporaryFolder folder;
  std::ofstream(folder / "asa.toml") << stochastic_approximation();
  const auto request = [&](const std::string& database) {
    auto made = request_for("", folder / database);
    made.protocol = folder / "asa.toml";
    return made;
  };
  const auto whole = run(request("whole.sqlite"));
  const auto expected = trials_of(folder / "whole.sqlite", whole.session_id);
  REQUIRE(whole.estimates.size() == 2);
  CHECK(whole.estimates[0].basis.find("the level after 20 answers with ") == 0);
  CHECK_FALSE(whole.estimates[0].sd.has_value());
  for (const int page : {70, 100, 130}) {
    INFO("cut at page " << page);
    const auto database = "cut" + std::to_string(page) + ".sqlite";
    Screen cut(page);
    session::Inputs inputs;
    CHECK_THROWS_AS(session::run(session::prepare(request(database)), &cut, inputs), std::runtime_error);
    const auto before = store::list_sessions(folder / database).front().trials;
    CHECK(before > 8);
    CHECK(before + 4 < static_cast<int>(expected.size()));
    std::ostringstream messages;
    auto resumed = session::prepare_resume({folder / database, "", "resume", true}, messages);
    REQUIRE(resumed.has_value());
    resumed->protocol.resume.warmup = 0;
    const auto summary = session::run(*resumed, nullptr, inputs);
    const auto trials = trials_of(folder / database, summary.session_id);
    REQUIRE(trials.size() == expected.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      CHECK(trials[i].level == expected[i].level);
      CHECK(trials[i].learned.state_hash == expected[i].learned.state_hash);
    }
    REQUIRE(summary.estimates.size() == 2);
    CHECK(summary.estimates[0].mean == whole.estimates[0].mean);
  }
}

TEST_CASE("a session log is not continued with a different protocol text", "[session]") {
  const TemporaryFolder folder;
  Screen cut(30);
  session::Inputs inputs;
  auto setup = session::prepare(request_for("demo", folder / "a.sqlite"));
  CHECK_THROWS(session::run(setup, &cut, inputs));
  std::ostringstream messages;
  auto resumed = session::prepare_resume({folder / "a.sqlite", "", "resume", true}, messages);
  REQUIRE(resumed.has_value());
  for (auto& value : resumed->protocol.procedures.front().values) value *= 0.5;
  CHECK_THROWS_AS(session::run(*resumed, nullptr, inputs), std::runtime_error);
}

TEST_CASE("a session log is not continued if factors would be combined in another way", "[session]") {
  // If the levels of a balanced factor are in another order, the staircase presents the same levels, but the
  // positions of the marks change.
  const TemporaryFolder folder;
  Screen cut(60);
  session::Inputs inputs;
  CHECK_THROWS(
      session::run(session::prepare(request_for("boundary-constant", folder / "a.sqlite")), &cut, inputs));
  std::ostringstream messages;
  auto resumed = session::prepare_resume({folder / "a.sqlite", "", "resume", true}, messages);
  REQUIRE(resumed.has_value());
  for (auto& factor : resumed->protocol.factors) std::reverse(factor.levels.begin(), factor.levels.end());
  std::string refused;
  try {
    session::run(*resumed, nullptr, inputs);
  } catch (const std::runtime_error& error) {
    refused = error.what();
  }
  CHECK(refused.find("other values of the factors") != std::string::npos);
}

TEST_CASE("all mistakes in a request are reported at once, and nothing is written", "[session]") {
  const TemporaryFolder folder;
  auto request = request_for("demo", folder / "a.sqlite");
  request.participant = "Jane Doe";
  request.language = "xx";
  CHECK_THROWS_AS(session::prepare(request), core::BadInput);
  request.participant = "P01";
  CHECK_THROWS_AS(session::prepare(request), core::BadInput);
  request.language.clear();
  request.observer.clear();
  request.mode = "live";
  CHECK_THROWS_AS(session::prepare(request), core::BadInput);
  CHECK_FALSE(fs::exists(folder / "a.sqlite"));
}

TEST_CASE("a monitor is notified before and after every trial and does not change any trial", "[session]") {
  const TemporaryFolder folder;
  Watch watch;
  session::Inputs inputs;
  const auto watched =
      session::run(session::prepare(request_for("demo", folder / "a.sqlite")), nullptr, inputs, &watch);
  const auto alone = run(request_for("demo", folder / "b.sqlite"));
  CHECK(static_cast<int>(watch.ended.size()) == watched.trials);
  CHECK(watch.announced == watch.ended);
  const auto a = trials_of(folder / "a.sqlite", watched.session_id);
  const auto b = trials_of(folder / "b.sqlite", alone.session_id);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CHECK(a[i].level == b[i].level);
    CHECK(a[i].timing.response_time_s == b[i].timing.response_time_s);
  }
}

TEST_CASE(
    "the latency of the response device and the consent form are stored, and response times are not "
    "corrected",
    "[session]") {
  const TemporaryFolder folder;
  auto setup = session::prepare(request_for("demo", folder / "a.sqlite"));
  setup.response_offset_s = 0.0625;
  setup.consent_version = "2026-03";
  session::Inputs inputs;
  const auto summary = session::run(setup, nullptr, inputs);
  const auto plain = run(request_for("demo", folder / "b.sqlite"));
  const auto stored = store::read_session(folder / "a.sqlite", summary.session_id);
  CHECK(stored.session.start.consent_version == "2026-03");
  const auto a = trials_of(folder / "a.sqlite", summary.session_id);
  const auto b = trials_of(folder / "b.sqlite", plain.session_id);
  CHECK(a.front().timing.response_offset_s == 0.0625);
  // A latency measured for the kernel's time stamps does not apply to other time stamps.
  setup.response_offset_quality = "kernel";
  setup.database = folder / "c.sqlite";
  const auto other = session::run(setup, nullptr, inputs);
  CHECK(trials_of(folder / "c.sqlite", other.session_id).front().timing.response_offset_s == 0);
  CHECK(a.front().timing.response_time_s == b.front().timing.response_time_s);
}

TEST_CASE("a simulated session is not continued with another simulated observer", "[session]") {
  const TemporaryFolder folder;
  const auto database = folder / "a.sqlite";
  Screen cut(30);
  session::Inputs inputs;
  const auto setup = session::prepare(request_for("demo", database));
  CHECK_THROWS_AS(session::run(setup, &cut, inputs), std::runtime_error);
  std::ostringstream messages;
  auto resumed = session::prepare_resume({database, "", "resume", true}, messages);
  REQUIRE(resumed.has_value());
  const auto before = store::list_sessions(database).front();
  REQUIRE(before.trials > 0);
  const auto kept = resumed->observer;
  resumed->observer = "sim:residual=0.4";
  CHECK_THROWS_AS(session::run(*resumed, nullptr, inputs), std::runtime_error);
  const auto after = store::list_sessions(database).front();
  CHECK(after.trials == before.trials);
  CHECK(after.segments == before.segments);
  resumed->observer = kept;
  CHECK(session::run(*resumed, nullptr, inputs).status == core::SessionStatus::completed);
}

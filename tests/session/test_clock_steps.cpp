// The wall clock is set or steered while a session runs. Times of trials, the order of rows and the days
// between sessions must not depend on it.
#include <atomic>
#include <cmath>

#include "station/session/planned_session.hpp"
#include "station/store/read.hpp"
#include "tests/session/live_room.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace turnpoint;
using namespace turnpoint::live_room;

namespace {

constexpr double kDeadline_s = 3.0;

/// A live session in which nobody answers the first trial, during which the wall clock changes.
struct SetClock {
  TemporaryFolder folder;
  session::Setup setup = live_setup(folder / "a.sqlite");
  Room room;
  std::atomic<std::int64_t> ahead_ns{0}, steered_since_ns{0};
  std::int64_t stimulus_ns = 0, missed_ns = 0;
  std::vector<std::int64_t> presses_ns;

  SetClock() {
    const std::string sessions = "[sessions]\ncount = 2\nmin_days = 1\n";
    setup.protocol = protocol::parse(protocol_text("buttons") + sessions, "live.toml");
  }

  void react(const session::Page& page, const std::function<void()>& change) {
    if (page.kind == PageKind::stimulus && room.stimuli == 1) {
      stimulus_ns = system::monotonic_ns();
      return change();
    }
    if (page.kind == PageKind::feedback && missed_ns == 0) missed_ns = system::monotonic_ns();
    if (page.kind == PageKind::stimulus) presses_ns.push_back(system::monotonic_ns());
    room.cooperate(page);
  }

  /// Runs the session and returns how the log says that the clock was changed. Empty if the machine was so
  /// busy that the first trial, which nobody answers, was void.
  std::optional<std::vector<std::string>> run(const std::function<void()>& change) {
    auto devices = room.devices();
    devices.clocks = [this] {
      auto clocks = system::read_clocks();
      clocks.realtime_ns += ahead_ns;
      // a time service that steers as fast as Linux lets it: 500 ppm
      if (steered_since_ns != 0) clocks.realtime_ns += (clocks.monotonic_ns - steered_since_ns) / 2000;
      return clocks;
    };
    room.reacts = [&](const auto& page) { react(page, change); };
    const auto summary = session::run(setup, &room, room.inputs, std::move(devices));
    for (const auto& page : room.pages)
      if (page.kind == PageKind::fault &&
          page.fault.kind != core::FaultKind::disarmed)  // before the session is armed
        CHECK(machine_was_busy(page.fault.kind));
    const auto trials = trials_of(setup.database, summary);
    if (!trials.empty() && trials.front().outcome == core::Outcome::fault) return std::nullopt;
    check(summary);
    std::vector<std::string> notices;
    for (const auto& event : events_of(setup.database, summary, "notice"))
      if (event.value.find("wall clock") != std::string::npos) notices.push_back(event.value);
    return notices;
  }

  void check(const session::Summary& summary) {
    CHECK(summary.status == core::SessionStatus::completed);
    // the deadline is neither earlier nor later
    const double waited_s = 1e-9 * static_cast<double>(missed_ns - stimulus_ns);
    CHECK(waited_s > kDeadline_s - 0.5);
    CHECK(waited_s < kDeadline_s + 10);
    CHECK(summary.duration_s > waited_s);
    CHECK(summary.duration_s < waited_s + 60);
    check_trials(summary);
    check_days(summary);
  }

  void check_trials(const session::Summary& summary) {
    const auto trials = trials_of(setup.database, summary);
    REQUIRE(trials.size() >= 2);
    CHECK(trials.front().outcome == core::Outcome::timeout);
    int answered = 0;
    for (std::size_t i = 0; i < trials.size(); ++i) {
      CHECK(trials[i].trial_index == static_cast<int>(i));
      if (i > 0) CHECK(trials[i].timing.onset_ns > trials[i - 1].timing.onset_ns);
      if (trials[i].outcome != core::Outcome::answered) continue;
      ++answered;
      CHECK(std::ranges::any_of(presses_ns, [&](std::int64_t pressed_ns) {
        const double pressed_s = 1e-9 * static_cast<double>(pressed_ns - trials[i].timing.onset_ns);
        return std::fabs(*trials[i].timing.response_time_s - pressed_s) < 0.05;
      }));
    }
    CHECK(answered == 2);
  }

  /// The next session may begin on the day after this one, by the date on which this one began.
  void check_days(const session::Summary& summary) {
    const auto earlier = store::list_sessions(setup.database, {"", summary.participant, ""});
    REQUIRE(earlier.size() == 1);
    const auto began = earlier.front().start.started_local;
    const auto next = session::next_session(setup, earlier, began);
    REQUIRE(next.too_early);
    CHECK(began.find(next.too_early->last_day) == 0);
    CHECK_FALSE(session::next_session(setup, earlier, next.too_early->allowed_from).too_early);
  }
};

/// Runs a session in which the clock is changed, and returns how the log says so.
std::vector<std::string> notices_after(const std::function<void(SetClock&)>& change) {
  for (int attempt = 0; attempt < 4; ++attempt) {
    SetClock session;
    if (auto notices = session.run([&] { change(session); })) return *notices;
  }
  FAIL("the machine was too busy for the first trial of four sessions");
  return {};
}

}  // namespace

TEST_CASE("a wall clock that is set during a session changes no time and no order, and is logged",
          "[session][live][clock]") {
  const auto hours = GENERATE(1, -1);
  const auto notices = notices_after(
      [&](SetClock& session) { session.ahead_ns = hours * 3600 * std::int64_t{1'000'000'000}; });
  REQUIRE(notices.size() == 1);
  CHECK(notices.front().find(hours > 0 ? "the wall clock was set by +3600."
                                       : "the wall clock was set by -3600.") == 0);
}

TEST_CASE("a wall clock that a time service steers during a session changes nothing",
          "[session][live][clock]") {
  CHECK(notices_after([](SetClock& session) { session.steered_since_ns = system::monotonic_ns(); }).empty());
}

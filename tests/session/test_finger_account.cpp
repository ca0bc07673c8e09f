#include "station/session/finger_account.hpp"
#include "station/system/clocks.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;
using session::finger_history;

namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr double kNow_s = 1.8e9;
const core::SegmentStart kNow{"this boot", "start", 0, 9000 * kSecond_ns,
                              static_cast<std::int64_t>(kNow_s) * kSecond_ns};

/// A session of one segment that began `ago_s` before now, when its monotonic clock read 5 s.
store::StoredSession session_of(double ago_s) {
  store::StoredSession session;
  core::SegmentStart segment;
  segment.monotonic_ns = 5 * kSecond_ns;
  segment.realtime_ns = static_cast<std::int64_t>(kNow_s - ago_s) * kSecond_ns;
  session.segments.push_back(segment);
  return session;
}

void add(store::StoredSession& session, double at_s, const std::string& kind, const std::string& value) {
  core::EventRow event;
  event.time_ns = 5 * kSecond_ns + static_cast<std::int64_t>(at_s * 1e9);
  event.kind = kind;
  event.value = value;
  event.trial_index = 0;
  session.events.push_back(event);
}

}  // namespace

TEST_CASE("stimuli are read from the database with their wall-clock times", "[session][limits]") {
  auto session = session_of(100);
  add(session, 60, "stimulus", "8.5");
  const auto history = finger_history({session}, kNow, 30);
  REQUIRE(history.stimuli.size() == 1);
  CHECK(history.stimuli[0].start_s - kNow_s == Approx(-40).margin(1e-5));
  CHECK(history.stimuli[0].end_s - kNow_s == Approx(-31.5).margin(1e-5));
  CHECK(history.period_start_s == Approx(kNow_s - 100).epsilon(1e-12));
}

TEST_CASE("a trial that a crash cut off counts as the longest stimulus", "[session][limits]") {
  auto session = session_of(20);
  add(session, 10, "presented", "");
  const auto history = finger_history({session}, kNow, 30);
  REQUIRE(history.stimuli.size() == 1);
  CHECK(history.stimuli[0].end_s - kNow_s == Approx(0).margin(1e-5));  // the stimulus counts only up to now
  core::BlockRecord block;
  block.trials.emplace_back();
  // negative control: a stored trial has ended, so it does not count as cut off
  session.blocks.push_back(block);
  CHECK(finger_history({session}, kNow, 30).stimuli.empty());
}

TEST_CASE("a trial of several parts that a crash cut off counts for as long as the duty allows",
          "[session][limits]") {
  CHECK(session::longest_trial_s({8e-6, 30, 0.8, 3600}) == Approx(48));
  CHECK(session::longest_trial_s({8e-6, 30, 0.4, 3600}) == 30);
  auto session = session_of(100);
  add(session, 10, "presented", "");
  const session::ExposureLimits limits{8e-6, 30, 0.8, 3600};
  const auto history = finger_history({session}, kNow, session::longest_trial_s(limits));
  REQUIRE(history.stimuli.size() == 1);
  CHECK(history.stimuli[0].end_s - history.stimuli[0].start_s == Approx(48).margin(1e-5));
}

TEST_CASE("a pause of half an hour begins a new period of exposure, but a crash does not",
          "[session][limits]") {
  auto earlier = session_of(3000);
  add(earlier, 1500, "stimulus", "1");  // the finger was stimulated until 1500 s ago
  CHECK(finger_history({earlier}, kNow, 30).period_start_s == Approx(kNow_s - 3000).epsilon(1e-12));
  auto long_ago = session_of(5000);
  // stimulated until 4000 s ago, which is 1000 s before the session `earlier` began
  add(long_ago, 1000, "stimulus", "1");
  CHECK(finger_history({earlier, long_ago}, kNow, 30).period_start_s == Approx(kNow_s - 5000).epsilon(1e-12));
  auto rested = session_of(3000);
  add(rested, 1000, "stimulus", "1");  // the finger was stimulated until 2000 s ago
  CHECK(finger_history({rested}, kNow, 30).period_start_s == kNow_s);
}

TEST_CASE("setting the wall clock does not make a finger's stimuli older or newer", "[session][limits]") {
  // The wall clock was set ahead by a day, or back by an hour, after the session.
  const double set_s = GENERATE(-86400.0, 3600.0);
  auto session = session_of(100 + set_s);
  session.segments[0].boot_id = kNow.boot_id;
  session.segments[0].boottime_ns = 8900 * kSecond_ns;
  add(session, 60, "stimulus", "8.5");
  const auto history = finger_history({session}, kNow, 30);
  REQUIRE(history.stimuli.size() == 1);
  CHECK(history.stimuli[0].start_s - kNow_s == Approx(-40).margin(1e-5));
  CHECK(history.period_start_s == Approx(kNow_s - 100).epsilon(1e-12));
  // After a restart of the machine, only the wall clock is left.
  session.segments[0].boot_id = "another boot";
  CHECK(finger_history({session}, kNow, 30).stimuli[0].start_s - kNow_s != Approx(-40).margin(1));
}

TEST_CASE("the intervals of a trial together keep the limits, even in a long session", "[session][limits]") {
  const session::ExposureLimits limits{8e-6, 30, 0.8, 1e9};
  session::FingerAccount account(limits, {{}, kNow_s}, 0, kNow_s);
  const std::vector<session::Exposed> trial{{0.8, 9.8}, {10.4, 19.4}};
  double shown_s = 0;
  std::int64_t now_ns = 0;
  for (int k = 0; k < 20; ++k) {
    now_ns = account.earliest_ns(now_ns, trial);
    for (const auto& part : trial)
      account.add(now_ns + static_cast<std::int64_t>(1e9 * part.start_s),
                  now_ns + static_cast<std::int64_t>(1e9 * part.end_s));
    now_ns += 19'500'000'000;
    shown_s += 18;
  }
  CHECK(shown_s / (1e-9 * static_cast<double>(now_ns)) < 0.81);
  CHECK(shown_s / (1e-9 * static_cast<double>(now_ns)) > 0.75);
}

TEST_CASE("a stimulus of exactly the longest continuous time is allowed, a longer one is not",
          "[session][limits]") {
  const session::ExposureLimits limits{8e-6, 30, 0.8, 1e9};
  const session::FingerAccount account(limits, {{}, kNow_s}, 0, kNow_s);
  CHECK(account.earliest_ns(0, {{0.8, 30.8}}) == 0);
  CHECK_THROWS_AS(account.earliest_ns(0, {{0.8, 30.9}}), session::LimitExceeded);
}

TEST_CASE("a suspended machine and a changed clock are distinguished, and slow corrections count as neither",
          "[session][clock]") {
  system::ClockWatch watch({0, 0, 100 * kSecond_ns});
  auto news = watch.look({kSecond_ns, kSecond_ns, 101 * kSecond_ns + 400'000});
  CHECK_FALSE(news.suspended_s.has_value());
  CHECK_FALSE(news.jump_s.has_value());
  news = watch.look({2 * kSecond_ns, 62 * kSecond_ns, 162 * kSecond_ns});
  REQUIRE(news.suspended_s.has_value());
  CHECK(*news.suspended_s == Approx(60));
  CHECK_FALSE(news.jump_s.has_value());
  news = watch.look({3 * kSecond_ns, 63 * kSecond_ns, 103 * kSecond_ns});
  CHECK_FALSE(news.suspended_s.has_value());
  REQUIRE(news.jump_s.has_value());
  CHECK(*news.jump_s == Approx(-60));
}

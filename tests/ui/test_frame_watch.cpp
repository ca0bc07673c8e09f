#include <QCoreApplication>

#include "station/ui/participant/frame_watch.hpp"
#include "tests/support/catch.hpp"

using turnpoint::ui::LateFrames;

TEST_CASE("each whole refresh beyond the first that a page takes to appear counts as a lost frame",
          "[frames]") {
  constexpr std::int64_t ms = 1'000'000;
  CHECK(LateFrames::lost(0, 60) == 0);
  CHECK(LateFrames::lost(16 * ms, 60) == 0);
  CHECK(LateFrames::lost(33 * ms, 60) == 0);  // two refreshes from the request to the shown page are allowed
  CHECK(LateFrames::lost(34 * ms, 60) == 1);
  CHECK(LateFrames::lost(1000 * ms, 60) == 59);
  CHECK(LateFrames::lost(34 * ms, 120) == 3);
}

TEST_CASE("a stall that delays both a page and the event loop is counted once", "[frames]") {
  constexpr std::int64_t ms = 1'000'000;
  LateFrames late(60);
  late.waited(1000 * ms, 1016 * ms);
  late.waited(1016 * ms, 1032 * ms);
  CHECK(late.count() == 0);
  late.waited(1032 * ms, 1132 * ms);  // the event loop was blocked for 100 ms
  CHECK(late.count() == 5);
  late.waited(1040 * ms, 1140 * ms);  // this delay overlaps the one already counted
  CHECK(late.count() == 5);
  late.waited(1132 * ms, 1148 * ms);
  late.waited(1140 * ms, 1240 * ms);  // now drawing is slow while the event loop runs
  CHECK(late.count() == 10);
}

TEST_CASE("a blocked event loop loses frames during a trial even if no page was to be shown", "[frames]") {
  constexpr std::int64_t ms = 1'000'000;
  int argc = 1;
  char name[] = "test";
  char* argv[] = {name, nullptr};
  const QCoreApplication application(argc, argv);
  std::int64_t now = 1000 * ms;
  turnpoint::ui::FrameWatch watch([&now] { return now; });
  CHECK(watch.end() == 0);  // no trial has begun
  watch.asked();
  now += 10 * ms;
  CHECK(watch.end() == 0);  // nothing was late in this trial
  watch.asked();
  now += 100 * ms;
  CHECK(watch.end() == 5);
  now += 1000 * ms;
  CHECK(watch.end() == 0);  // the loss was already reported, and delays between trials do not count
}

#include <QCoreApplication>

#include "station/ui/participant/frame_watch.hpp"
#include "tests/support/catch.hpp"

using turnpoint::ui::LateFrames;

TEST_CASE("a frame is lost for each whole refresh beyond the first that a page took", "[frames]") {
  constexpr std::int64_t ms = 1'000'000;
  CHECK(LateFrames::lost(0, 60) == 0);
  CHECK(LateFrames::lost(16 * ms, 60) == 0);
  CHECK(LateFrames::lost(33 * ms, 60) == 0);  // requested just after a refresh, shown at the next but one
  CHECK(LateFrames::lost(34 * ms, 60) == 1);
  CHECK(LateFrames::lost(1000 * ms, 60) == 59);
  CHECK(LateFrames::lost(34 * ms, 120) == 3);
}

TEST_CASE("a stall that a page and the loop of events both waited for is counted once", "[frames]") {
  constexpr std::int64_t ms = 1'000'000;
  LateFrames late(60);
  late.waited(1000 * ms, 1016 * ms);
  late.waited(1016 * ms, 1032 * ms);
  CHECK(late.count() == 0);
  late.waited(1032 * ms, 1132 * ms);  // the event loop stood still
  CHECK(late.count() == 5);
  late.waited(1040 * ms, 1140 * ms);  // a page requested meanwhile, shown as soon as the loop continued
  CHECK(late.count() == 5);
  late.waited(1132 * ms, 1148 * ms);
  late.waited(1140 * ms, 1240 * ms);  // another thread drew slowly, while the loop kept running
  CHECK(late.count() == 10);
}

TEST_CASE("a loop that stands still during a trial loses frames even where no page was to be shown",
          "[frames]") {
  constexpr std::int64_t ms = 1'000'000;
  int argc = 1;
  char name[] = "test";
  char* argv[] = {name, nullptr};
  const QCoreApplication application(argc, argv);
  std::int64_t now = 1000 * ms;
  turnpoint::ui::FrameWatch watch([&now] { return now; });
  CHECK(watch.end() == 0);  // no trial
  watch.asked();
  now += 10 * ms;
  CHECK(watch.end() == 0);  // nothing was late
  watch.asked();
  now += 100 * ms;
  CHECK(watch.end() == 5);
  now += 1000 * ms;
  CHECK(watch.end() == 0);  // reported once; what comes between trials does not count
}

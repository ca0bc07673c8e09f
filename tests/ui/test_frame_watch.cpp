#include "station/ui/frame_watch.hpp"
#include "tests/support/catch.hpp"

using turnpoint::ui::FrameWatch;

TEST_CASE("a frame is lost for each whole refresh beyond the first that a page took", "[frames]") {
  constexpr std::int64_t ms = 1'000'000;
  CHECK(FrameWatch::lost(0, 60) == 0);
  CHECK(FrameWatch::lost(16 * ms, 60) == 0);
  CHECK(FrameWatch::lost(33 * ms, 60) == 0);  // asked for just after a refresh, shown at the next but one
  CHECK(FrameWatch::lost(34 * ms, 60) == 1);
  CHECK(FrameWatch::lost(1000 * ms, 60) == 59);
  CHECK(FrameWatch::lost(34 * ms, 120) == 3);
}

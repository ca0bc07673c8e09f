// Tests what a participant's page says of the time that a session still takes.
#include <cstdint>

#include "station/ui/participant/page_model.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint;

TEST_CASE("the minutes left follow the pace of the session, and are not said before it has one",
          "[ui][progress]") {
  std::int64_t now_ns = 5'000'000'000;
  ui::PageModel model([&] { return now_ns; });
  const auto left_after = [&](int done, int total, double seconds) {
    now_ns += static_cast<std::int64_t>(seconds * 1e9);
    session::Page page;
    page.trials_done = done, page.trials_total = total;
    model.set(page);
    return model.minutes_left();
  };
  CHECK(left_after(0, 60, 0) == -1);
  CHECK(left_after(4, 60, 40) == -1);    // four trials tell no pace
  CHECK(left_after(5, 60, 10) == 10);    // 55 trials of 10 s: 9.2 minutes
  CHECK(left_after(30, 60, 240) == 5);   // 30 trials of 9.7 s: 4.8 minutes
  CHECK(left_after(31, 70, 10) == 7);    // trials to be repeated count: 39 trials are left
  CHECK(left_after(35, 70, 550) == 15);  // slower: 24 s a trial
  CHECK(left_after(69, 70, 0) == 1);     // never 0 while a trial is left
  CHECK(left_after(70, 70, 10) == -1);
  // another session, which is resumed after 20 trials: the pace is its own
  CHECK(left_after(20, 40, 3600) == -1);
  CHECK(left_after(25, 40, 0) == 1);
  CHECK(left_after(25, 40, 95) == 5);  // 15 trials of 19 s
}

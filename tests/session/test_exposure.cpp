#include "station/session/exposure.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::session;

namespace {
const ExposureLimits limits{8e-6, 30, 0.8, 3600};
}

TEST_CASE("a stimulus beyond a limit is refused with the limit's name and value", "[drive][exposure]") {
  const Exposure exposure(limits, 0);
  CHECK_NOTHROW(exposure.check(8e-6, 30));
  CHECK_THROWS_WITH(exposure.check(8.1e-6, 1), "displacement of 8.100 um; the rig allows 8.000 um");
  CHECK_THROWS_WITH(exposure.check(1e-6, 31), "stimulus of 31.000 s; the rig allows 30.000 s without a rest");
  CHECK_THROWS_AS(Exposure({8e-6, 50, 0.5, 3600}, 0).check(1e-6, 40), LimitExceeded);
  CHECK_THROWS_AS(Exposure({8e-6, 50, 1.5, 3600}, 0), std::invalid_argument);
}

TEST_CASE(
    "a pause is extended only as far as the duty cycle requires, and no window of a minute exceeds the limit",
    "[drive][exposure]") {
  Exposure exposure(limits, 0);
  double time = 0;
  std::vector<Exposed> all;
  for (int k = 0; k < 100; ++k) {
    const double start = exposure.earliest_start_s(time, 9.0);
    all.push_back({start, start + 9.0});
    exposure.add(all.back());
    time = start + 9.0 + 0.6;  // with these pauses the duty cycle would be 0.94
  }
  double largest = 0;
  for (double from = 0; from < all.back().end_s; from += 0.25) {
    double on = 0;
    for (const Exposed& e : all)
      on += std::max(0.0, std::min(e.end_s, from + 60) - std::max(e.start_s, from));
    largest = std::max(largest, on);
  }
  CHECK(largest <= 48.0 + 1e-6);
  CHECK(largest > 47.5);
  CHECK(all.back().end_s < 100 * 9.0 / 0.8 * 1.02);
}

TEST_CASE("stimuli without a rest between them count as one continuous exposure", "[drive][exposure]") {
  Exposure exposure(limits, 0);
  exposure.add({0, 20});
  CHECK(exposure.earliest_start_s(20.1, 5) == Approx(20.1));
  // a stimulus of 15 s must wait for a rest of 0.5 s
  CHECK(exposure.earliest_start_s(20.1, 15) == Approx(20.5));
}

TEST_CASE("a restart resets no limit, because history and session start come from the database",
          "[drive][exposure]") {
  Exposure before(limits, 1000);
  std::vector<Exposed> presented;
  for (double t = 1000; t < 1050; t += 10) presented.push_back({t, t + 9.4});
  for (const Exposed& e : presented) before.add(e);
  const Exposure after(limits, 1000, presented);
  CHECK(after.earliest_start_s(1051, 9) == before.earliest_start_s(1051, 9));
  CHECK(after.earliest_start_s(1051, 9) > 1051);
  CHECK_THROWS_WITH(after.earliest_start_s(4595, 9), "the session's time of 60.0 min is used up");
}

TEST_CASE("a live session needs a measured sound level below 22.4 kHz", "[drive][exposure]") {
  const std::vector<SoundLevel> measured{{8000, 80}, {20000, 70}, {30000, 120}};
  CHECK_FALSE(sound_problem(22400, 1, {}));
  CHECK(sound_problem(22399, 1, {}));
  CHECK(sound_problem(7000, 0.1, measured));  // 7 kHz is outside the measured range
  CHECK(sound_problem(8000, 1, measured));
  CHECK_FALSE(sound_problem(8000, 0.5, measured));  // half the amplitude gives 74 dB
  // between two measured frequencies, the louder of their levels counts
  CHECK(sound_problem(15000, 0.6, measured));
  CHECK(sound_problem(26000, 1, measured));
  CHECK_FALSE(sound_problem(26000, 0.3, measured));
}

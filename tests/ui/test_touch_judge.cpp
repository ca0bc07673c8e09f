#include "station/ui/participant/touch_judge.hpp"
#include "tests/support/catch.hpp"

using turnpoint::ui::Touch;
using turnpoint::ui::TouchJudge;

namespace {

constexpr std::int64_t ms = 1'000'000;
constexpr std::int64_t settle = TouchJudge::Rules{}.settle_ns;

Touch touch(std::int64_t time_ns, int target, double diameter_mm = 0) {
  return {time_ns, target, diameter_mm};
}

}  // namespace

TEST_CASE("one finger on an answer gives this answer, with the time at which the finger touched down",
          "[touch]") {
  TouchJudge judge;
  judge.open();
  judge.down(touch(500 * ms, 1));
  CHECK(judge.pressed() == 1);
  CHECK_FALSE(judge.decide(500 * ms + settle - 1));
  const auto answer = judge.decide(500 * ms + settle);
  REQUIRE(answer);
  CHECK(answer->target == 1);
  CHECK(answer->time_ns == 500 * ms);
  CHECK(judge.pressed() == 1);
}

TEST_CASE("a touch that began before the answers opened never answers", "[touch]") {
  TouchJudge judge;
  judge.down(touch(100 * ms, 0));
  judge.open();
  CHECK_FALSE(judge.decide(1000 * ms));
  SECTION("but it does not keep another finger from answering") {
    judge.down(touch(400 * ms, 1));
    CHECK(judge.decide(400 * ms + settle)->target == 1);
  }
}

TEST_CASE("the second tap of a double tap is ignored until answers are accepted again", "[touch]") {
  TouchJudge judge;
  judge.open();
  judge.down(touch(500 * ms, 0));
  REQUIRE(judge.decide(600 * ms));
  judge.down(touch(650 * ms, 1));
  CHECK_FALSE(judge.decide(900 * ms));
  judge.close();
  judge.down(touch(950 * ms, 1));
  judge.open();
  CHECK_FALSE(judge.decide(1200 * ms));
}

TEST_CASE("the second tap of a double tap does not replace the first one before it was read", "[touch]") {
  TouchJudge judge;
  judge.open();
  judge.down(touch(500 * ms, 0));
  judge.down(touch(600 * ms, 1));
  const auto answer = judge.decide(700 * ms);
  REQUIRE(answer);
  CHECK(answer->target == 0);
}

TEST_CASE("ten fingers at once give no answer and leave the question open", "[touch]") {
  TouchJudge judge;
  judge.open();
  for (int finger = 0; finger < 10; ++finger) {
    judge.down(touch(500 * ms + finger * 3 * ms, finger % 2));
    CHECK_FALSE(judge.decide(500 * ms + finger * 3 * ms + 1));
  }
  CHECK(judge.pressed() == -1);
  CHECK_FALSE(judge.decide(2000 * ms));
  judge.down(touch(2500 * ms, 1));
  CHECK(judge.decide(2600 * ms)->target == 1);
}

TEST_CASE("fingers further apart than the settling time are two taps: the first one answers", "[touch]") {
  TouchJudge judge;  // negative control for the rule that simultaneous touches do not count
  judge.open();
  judge.down(touch(500 * ms, 0));
  judge.down(touch(500 * ms + settle + 1, 1));
  CHECK(judge.decide(600 * ms)->target == 0);
}

TEST_CASE("a palm gives no answer, but a broad thumb does", "[touch]") {
  TouchJudge judge;
  judge.open();
  judge.down(touch(500 * ms, 0, 32));
  CHECK_FALSE(judge.decide(600 * ms));
  judge.down(touch(700 * ms, 1, 18));
  CHECK(judge.decide(800 * ms)->target == 1);
}

TEST_CASE("a hand that rests beside the answers does not block them", "[touch]") {
  TouchJudge judge;
  judge.open();
  judge.down(touch(300 * ms, -1));
  judge.down(touch(900 * ms, 0));
  CHECK(judge.decide(1000 * ms)->target == 0);
}

TEST_CASE("touches that the system cancels give no answer", "[touch]") {
  TouchJudge judge;
  judge.open();
  judge.down(touch(300 * ms, 0));
  judge.cancel();
  CHECK_FALSE(judge.decide(400 * ms));
}

#include "station/panel/evdev_contact.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::panel;

namespace {

input_event event(int type, int code, int value, long milliseconds) {
  input_event made{};
  made.type = static_cast<unsigned short>(type);
  made.code = static_cast<unsigned short>(code);
  made.value = value;
  made.input_event_sec = milliseconds / 1000;
  made.input_event_usec = milliseconds % 1000 * 1000;
  return made;
}

}  // namespace

TEST_CASE("a finger that comes, moves and goes is told once a report, with the kernel's time",
          "[panel][contact]") {
  ContactReader reader(ABS_X, 100, 1100);
  CHECK_FALSE(reader.take(event(EV_KEY, BTN_TOUCH, 1, 5000)));
  CHECK_FALSE(reader.take(event(EV_ABS, ABS_X, 350, 5000)));
  const auto down = reader.take(event(EV_SYN, SYN_REPORT, 0, 5001));
  REQUIRE(down);
  CHECK(down->on);
  CHECK(down->position.value() == Approx(0.25));
  CHECK(down->time_ns == 5'001'000'000);
  CHECK_FALSE(reader.take(event(EV_ABS, ABS_X, 355, 5010)));
  CHECK_FALSE(reader.take(event(EV_SYN, SYN_REPORT, 0, 5010)));  // less than a hundredth
  CHECK_FALSE(reader.take(event(EV_ABS, ABS_X, 600, 5020)));
  CHECK(reader.take(event(EV_SYN, SYN_REPORT, 0, 5020))->position.value() == Approx(0.5));
  CHECK_FALSE(reader.take(event(EV_KEY, BTN_TOUCH, 0, 5030)));
  CHECK_FALSE(reader.take(event(EV_SYN, SYN_REPORT, 0, 5030))->on);
}

TEST_CASE("after dropped events the state is taken up anew", "[panel][contact]") {
  ContactReader reader(ABS_X, 0, 1000);
  CHECK_FALSE(reader.take(event(EV_SYN, SYN_DROPPED, 0, 1)));
  CHECK_FALSE(reader.take(event(EV_KEY, BTN_TOUCH, 1, 2)));
  CHECK_FALSE(reader.take(event(EV_SYN, SYN_REPORT, 0, 2)));
  CHECK(reader.dropped());
  reader.recovered(true, 500);
  const auto touch = reader.take(event(EV_SYN, SYN_REPORT, 0, 3));
  REQUIRE(touch);
  CHECK(touch->on);
}

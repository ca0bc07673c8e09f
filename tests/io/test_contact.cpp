#include "station/io/evdev_contact.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::io;

TEST_CASE("touch, movement and lift of a finger are reported once per kernel report, with the kernel's time",
          "[touch][contact]") {
  ContactReader reader({100, 1100});
  CHECK_FALSE(reader.take(1, false, 350));
  const auto down = reader.take(5'001'000'000, true, 350);
  REQUIRE(down);
  CHECK(down->on);
  CHECK(down->position.value() == Approx(0.25));
  CHECK(down->time_ns == 5'001'000'000);
  CHECK_FALSE(reader.take(5'010'000'000, true,
                          355));  // not reported: the finger moved by less than a hundredth of the range
  CHECK(reader.take(5'020'000'000, true, 600)->position.value() == Approx(0.5));
  CHECK_FALSE(reader.take(5'030'000'000, false, 600)->on);
  CHECK_FALSE(reader.take(5'040'000'000, false, 900));
  CHECK(reader.take(5'050'000'000, true, 1250)->position.value() == 1);  // outside of the stated range
}

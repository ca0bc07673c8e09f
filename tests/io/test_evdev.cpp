#include <optional>
#include <vector>

#include "station/io/evdev_contact.hpp"
#include "station/io/touch_times.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fake_evdev.hpp"

using namespace turnpoint::io;
using News = EvdevDevice::News;

TEST_CASE("a touch device is read report by report, with the kernel's time stamps", "[touch][evdev]") {
  FakeEvdev fake(0);
  EvdevDevice device(fake.descriptor(), "fake");
  CHECK(device.range(ABS_X).highest == 799);
  CHECK(device.slot_count() == 0);
  CHECK_THROWS_AS(device.range(ABS_MT_POSITION_X), std::system_error);
  CHECK(device.next() == News::none);
  fake.send(5'000'001, EV_ABS, ABS_X, 400);
  fake.send(5'000'001, EV_KEY, BTN_TOUCH, 1);
  CHECK(device.next() == News::none);  // SYN_REPORT is missing, so the report is incomplete
  fake.send(5'000'002, EV_SYN, SYN_REPORT, 0);
  fake.send(5'000'003, EV_KEY, BTN_TOUCH, 0);
  fake.send(5'000'003, EV_SYN, SYN_REPORT, 0);
  REQUIRE(device.next() == News::report);
  CHECK(device.time_ns() == 5'000'002'000);
  CHECK(device.key(BTN_TOUCH));
  CHECK(device.axis(ABS_X) == 400);
  REQUIRE(device.next() == News::report);
  CHECK_FALSE(device.key(BTN_TOUCH));
  CHECK(device.next() == News::none);
}

TEST_CASE("a lift that the kernel dropped is noticed once the kernel reports dropped events",
          "[touch][evdev]") {
  FakeEvdev fake(0);
  EvdevDevice device(fake.descriptor(), "fake");
  ContactReader contact(device.range(ABS_X));
  const auto take = [&] { return contact.take(device.time_ns(), device.key(BTN_TOUCH), device.axis(ABS_X)); };
  fake.send(10, EV_KEY, BTN_TOUCH, 1);
  fake.send(10, EV_ABS, ABS_X, 200);
  fake.send(10, EV_SYN, SYN_REPORT, 0);
  REQUIRE(device.next() == News::report);
  REQUIRE(take());
  fake.axes[ABS_X] = 700;  // while events are lost, the finger moves and is lifted
  fake.touched = false;
  fake.send(2000, EV_SYN, SYN_DROPPED, 0);
  fake.send(2000, EV_ABS, ABS_X, 650);
  fake.send(2000, EV_SYN, SYN_REPORT, 0);
  REQUIRE(device.next() == News::resynchronised);
  const auto lifted = take();
  REQUIRE(lifted);
  CHECK_FALSE(lifted->on);
  CHECK(lifted->time_ns == 2'000'000);
  CHECK(device.next() == News::none);
  fake.send(3000, EV_KEY, BTN_TOUCH, 1);
  fake.send(3000, EV_SYN, SYN_REPORT, 0);
  REQUIRE(device.next() == News::report);
  const auto again = take();
  REQUIRE(again);
  CHECK(again->on);
  CHECK(again->position.value() == Approx(700.0 / 799));
}

TEST_CASE("after dropped events, fingers are in the slots and at the places that the kernel reports",
          "[touch][evdev]") {
  FakeEvdev fake(2);
  EvdevDevice device(fake.descriptor(), "fake");
  REQUIRE(device.slot_count() == 2);
  fake.send(10, EV_ABS, ABS_MT_SLOT, 0);
  fake.send(10, EV_ABS, ABS_MT_TRACKING_ID, 5);
  fake.send(10, EV_ABS, ABS_MT_POSITION_X, 80);
  fake.send(10, EV_ABS, ABS_MT_POSITION_Y, 48);
  fake.send(10, EV_SYN, SYN_REPORT, 0);
  REQUIRE(device.next() == News::report);
  CHECK(device.slot(0, ABS_MT_TRACKING_ID) == 5);
  // While events are lost, this finger is lifted and another touches in the other slot, which becomes the
  // current slot.
  fake.slot_values[0][ABS_MT_TRACKING_ID] = -1;
  fake.slot_values[1] = {{ABS_MT_TRACKING_ID, 6}, {ABS_MT_POSITION_X, 720}, {ABS_MT_POSITION_Y, 432}};
  fake.axes[ABS_MT_SLOT] = 1;
  fake.touched = true;
  fake.send(20, EV_SYN, SYN_DROPPED, 0);
  fake.send(20, EV_SYN, SYN_REPORT, 0);
  REQUIRE(device.next() == News::resynchronised);
  CHECK(device.slot(0, ABS_MT_TRACKING_ID) == -1);
  CHECK(device.slot(1, ABS_MT_TRACKING_ID) == 6);
  CHECK(device.slot(1, ABS_MT_POSITION_X) == 720);
  // The kernel does not send the slot again, so the next event belongs to the slot that is now current.
  fake.send(30, EV_ABS, ABS_MT_TRACKING_ID, -1);
  fake.send(30, EV_SYN, SYN_REPORT, 0);
  fake.send(40, EV_ABS, ABS_MT_TRACKING_ID, 7);
  fake.send(40, EV_SYN, SYN_REPORT, 0);
  REQUIRE(device.next() == News::report);
  CHECK(device.slot(1, ABS_MT_TRACKING_ID) == -1);
  REQUIRE(device.next() == News::report);
  CHECK(device.slot(1, ABS_MT_TRACKING_ID) == 7);
  CHECK(device.slot(1, ABS_MT_POSITION_Y) == 432);
  CHECK(device.time_ns() == 40'000);
}

TEST_CASE("after dropped events, touches belong to the right finger, and no touch is reported without a time",
          "[touch][evdev]") {
  TouchDecoder decoder({0, 799}, {0, 479});
  const std::vector<Finger> none(2);
  decoder.resynchronise(none);
  const std::vector<Finger> held{{std::nullopt, 0, 0}, {6, 720, 432}};
  decoder.resynchronise(held);  // the finger touched while events were lost
  CHECK(decoder.report(20'000, held).empty());
  CHECK(decoder.report(30'000, none).empty());
  const std::vector<Finger> again{{std::nullopt, 0, 0}, {7, 720, 432}};
  const auto touches = decoder.report(40'000, again);
  REQUIRE(touches.size() == 1);
  CHECK(touches[0].time_ns == 40'000);
  CHECK(touches[0].x == Approx(720.0 / 799));
  CHECK(touches[0].y == Approx(432.0 / 479));
}

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <vector>

#include "station/core/usage_error.hpp"
#include "station/io/evdev_contact.hpp"
#include "station/io/touch_times.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/fake_evdev.hpp"
#include "tests/support/temporary_folder.hpp"

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

TEST_CASE(
    "of several nodes with one name the touched one is read, and two touched ones are refused with their "
    "paths",
    "[touch][evdev]") {
  TemporaryFolder folder;
  std::vector<std::unique_ptr<FakeEvdev>> nodes;
  const auto add = [&](int slots, std::vector<int> keys,
                       const std::string& name = "ACME Touch") -> FakeEvdev& {
    const auto path = folder / ("event" + std::to_string(nodes.size()));
    nodes.push_back(std::make_unique<FakeEvdev>(slots, path));
    nodes.back()->keys = std::move(keys);
    nodes.back()->name = name;
    return *nodes.back();
  };
  const auto find = [&](const std::string& name = "ACME Touch") {
    return EvdevDevice::find(name, folder.path);
  };
  std::ofstream(folder / "mouse0") << "not an event node";
  CHECK_FALSE(find());
  SECTION("a mouse that reports positions comes first, as on many touch controllers") {
    add(0, {BTN_LEFT, BTN_RIGHT});
    add(10, {BTN_TOUCH});
    add(10, {BTN_TOUCH}, "another panel");
    const auto found = find();
    REQUIRE(found);
    CHECK(found->slot_count() == 10);
    CHECK(found->is_touched());
    CHECK_FALSE(EvdevDevice::find(folder / "event0")->is_touched());
  }
  SECTION("a panel that cannot tell fingers apart, and a mouse and a keyboard without axes") {
    add(0, {BTN_LEFT}).axes.clear();
    add(0, {BTN_TOUCH});
    add(0, {KEY_ENTER}).axes.clear();
    REQUIRE(find());
    CHECK(find()->is_touched());
  }
  SECTION("two panels") {
    add(10, {BTN_TOUCH});
    add(0, {BTN_LEFT});
    add(10, {BTN_TOUCH});
    CHECK_THROWS_WITH(find(),
                      "input device 'ACME Touch': 2 devices have this name: " + (folder / "event0") + ", " +
                          (folder / "event2") +
                          "; write the path of one of them, best a link below /dev/input/by-path, which "
                          "stays the same after a restart");
    // the way out that the message names
    std::filesystem::create_symlink(folder / "event2", folder / "by-path");
    CHECK(EvdevDevice::find(folder / "by-path")->slot_count() == 10);
  }
  SECTION("two nodes of which none is touched") {
    add(0, {BTN_LEFT});
    add(0, {BTN_LEFT});
    CHECK_THROWS_AS(find(), turnpoint::core::UsageError);
  }
  SECTION("one node of the name, whatever it is") {
    add(0, {BTN_LEFT});
    CHECK(find());
    CHECK_FALSE(find("ACME"));
  }
}

#include "station/panel/touch_reader.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::panel;

namespace {

constexpr std::int64_t ms = 1'000'000;

input_event event(int time_ms, int type, int code, int value) {
  input_event e{};
  e.input_event_sec = time_ms / 1000;
  e.input_event_usec = (time_ms % 1000) * 1000;
  e.type = static_cast<unsigned short>(type);
  e.code = static_cast<unsigned short>(code);
  e.value = value;
  return e;
}

std::vector<PanelTouch> feed(TouchDecoder& decoder, const std::vector<input_event>& events) {
  std::vector<PanelTouch> touches;
  for (const auto& e : events)
    for (const auto& touch : decoder.handle(e)) touches.push_back(touch);
  return touches;
}

TouchDecoder slots() { return {TouchProtocol::slots, {0, 799}, {0, 479}}; }

}  // namespace

TEST_CASE("a finger that comes down is one touch, at the time of its report", "[touch]") {
  auto decoder = slots();
  const auto touches =
      feed(decoder, {event(1500, EV_ABS, ABS_MT_TRACKING_ID, 7), event(1500, EV_ABS, ABS_MT_POSITION_X, 799),
                     event(1500, EV_ABS, ABS_MT_POSITION_Y, 0), event(1500, EV_KEY, BTN_TOUCH, 1),
                     event(1500, EV_SYN, SYN_REPORT, 0), event(1510, EV_ABS, ABS_MT_POSITION_X, 700),
                     event(1510, EV_SYN, SYN_REPORT, 0), event(1520, EV_ABS, ABS_MT_TRACKING_ID, -1),
                     event(1520, EV_SYN, SYN_REPORT, 0)});
  REQUIRE(touches.size() == 1);
  CHECK(touches[0].time_ns == 1500 * ms);
  CHECK(touches[0].x == 1);
  CHECK(touches[0].y == 0);
}

TEST_CASE("two fingers in one report are two touches, each at its place", "[touch]") {
  auto decoder = slots();
  const auto touches =
      feed(decoder, {event(10, EV_ABS, ABS_MT_SLOT, 0), event(10, EV_ABS, ABS_MT_TRACKING_ID, 1),
                     event(10, EV_ABS, ABS_MT_POSITION_X, 100), event(10, EV_ABS, ABS_MT_POSITION_Y, 100),
                     event(10, EV_ABS, ABS_MT_SLOT, 1), event(10, EV_ABS, ABS_MT_TRACKING_ID, 2),
                     event(10, EV_ABS, ABS_MT_POSITION_X, 600), event(10, EV_ABS, ABS_MT_POSITION_Y, 400),
                     event(10, EV_SYN, SYN_REPORT, 0)});
  REQUIRE(touches.size() == 2);
  CHECK(touches[0].x == Approx(100.0 / 799));
  CHECK(touches[1].x == Approx(600.0 / 799));
}

TEST_CASE("a second tap at the very same place is seen although the kernel repeats no position", "[touch]") {
  auto decoder = slots();
  feed(decoder, {event(10, EV_ABS, ABS_MT_TRACKING_ID, 1), event(10, EV_ABS, ABS_MT_POSITION_X, 100),
                 event(10, EV_ABS, ABS_MT_POSITION_Y, 100), event(10, EV_SYN, SYN_REPORT, 0),
                 event(20, EV_ABS, ABS_MT_TRACKING_ID, -1), event(20, EV_SYN, SYN_REPORT, 0)});
  const auto again =
      feed(decoder, {event(90, EV_ABS, ABS_MT_TRACKING_ID, 2), event(90, EV_SYN, SYN_REPORT, 0)});
  REQUIRE(again.size() == 1);
  CHECK(again[0].time_ns == 90 * ms);
}

TEST_CASE("what the kernel marks as incomplete is no touch", "[touch]") {
  auto decoder = slots();
  const auto touches =
      feed(decoder, {event(10, EV_ABS, ABS_MT_TRACKING_ID, 1), event(10, EV_SYN, SYN_DROPPED, 0),
                     event(10, EV_ABS, ABS_MT_POSITION_X, 100), event(11, EV_SYN, SYN_REPORT, 0),
                     event(12, EV_ABS, ABS_MT_POSITION_Y, 100), event(12, EV_SYN, SYN_REPORT, 0)});
  CHECK(touches.empty());
}

TEST_CASE("a panel without slots is read by its button", "[touch]") {
  TouchDecoder decoder(TouchProtocol::single, {0, 4095}, {0, 4095});
  const auto touches = feed(decoder, {event(5, EV_ABS, ABS_X, 4095), event(5, EV_ABS, ABS_Y, 2048),
                                      event(5, EV_KEY, BTN_TOUCH, 1), event(5, EV_SYN, SYN_REPORT, 0),
                                      event(9, EV_ABS, ABS_X, 1), event(9, EV_SYN, SYN_REPORT, 0)});
  REQUIRE(touches.size() == 1);
  CHECK(touches[0].x == 1);
}

TEST_CASE("an axis without extent is refused by name", "[touch]") {
  CHECK_THROWS_AS(TouchDecoder(TouchProtocol::single, {0, 0}, {0, 1}), std::invalid_argument);
}

TEST_CASE("the toolkit's touch gets the kernel's time of the touch at its place", "[touch]") {
  TouchTimes times;
  times.add({100 * ms, 0.20, 0.80});
  times.add({130 * ms, 0.70, 0.80});
  CHECK(times.claim(0.705, 0.79, 160 * ms) == 130 * ms);
  CHECK(times.claim(0.205, 0.79, 165 * ms) == 100 * ms);
}

TEST_CASE("a claimed touch is used up", "[touch]") {
  TouchTimes times;
  times.add({100 * ms, 0.2, 0.8});
  REQUIRE(times.claim(0.2, 0.8, 120 * ms));
  CHECK_FALSE(times.claim(0.2, 0.8, 121 * ms));
}

TEST_CASE("no pair is made from another place, from the future or from long ago", "[touch]") {
  TouchTimes times;
  times.add({1000 * ms, 0.2, 0.8});
  CHECK_FALSE(times.claim(0.3, 0.8, 1020 * ms));
  CHECK_FALSE(times.claim(0.2, 0.8, 999 * ms));
  CHECK_FALSE(times.claim(0.2, 0.8, 1500 * ms));
  CHECK(times.claim(0.2, 0.8, 1020 * ms));
}

TEST_CASE("two touches that both fit make no pair, rather than a guess", "[touch]") {
  TouchTimes times;
  times.add({100 * ms, 0.2, 0.8});
  times.add({180 * ms, 0.2, 0.8});
  CHECK_FALSE(times.claim(0.2, 0.8, 200 * ms));
  times.add({600 * ms, 0.2, 0.8});
  CHECK(times.claim(0.2, 0.8, 620 * ms) == 600 * ms);
}

TEST_CASE("a touch panel that is not there is an error that names it", "[touch]") {
  try {
    TouchReader reader("No such panel", [](TouchPanelState) {});
    FAIL("opened a panel that does not exist");
  } catch (const std::invalid_argument& error) {
    CHECK(std::string(error.what()).find("No such panel") != std::string::npos);
  }
  CHECK_THROWS_AS(TouchReader("/dev/input/event999", [](TouchPanelState) {}), std::system_error);
}

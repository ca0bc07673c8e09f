#include "station/panel/guard.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::panel;
using turnpoint::drive::AmplifierState;

namespace {

constexpr std::int64_t ms = 1'000'000;

void show_life(Guard& guard, std::int64_t now_ns) {
  guard.audio_alive(now_ns);
  guard.session_alive(now_ns);
}

Guard enabled_guard() {
  Guard guard;
  show_life(guard, 0);
  REQUIRE(guard.arm(0).empty());
  REQUIRE(guard.enable(0).empty());
  return guard;
}

}  // namespace

TEST_CASE("after a start the amplifier is disarmed and cannot be enabled before an operator arms it",
          "[panel][guard]") {
  Guard guard;
  show_life(guard, 0);
  CHECK(guard.state() == AmplifierState::disarmed);
  CHECK(guard.outputs().enable == 0);
  CHECK(guard.enable(0) == "disarmed: an operator has to arm it");
  CHECK(guard.arm(0).empty());
  CHECK(guard.outputs().enable == 0);
  CHECK(guard.enable(0).empty());
  CHECK(guard.outputs().enable == 1);
  guard.disable();
  CHECK(guard.outputs().enable == 0);
  CHECK(guard.state() == AmplifierState::armed);
}

TEST_CASE("it cannot be armed before audio and session have given signs of life", "[panel][guard]") {
  Guard guard;
  CHECK(guard.arm(0) == "the audio thread gives no sign");
  guard.audio_alive(0);
  CHECK(guard.arm(0) == "the session gives no sign");
  guard.session_alive(0);
  CHECK(guard.arm(0).empty());
}

TEST_CASE("a fault drops the line and stays latched until the cause is gone and an operator clears it",
          "[panel][guard]") {
  Guard guard = enabled_guard();
  guard.fault_line(5 * ms, true);
  CHECK(guard.outputs().enable == 0);
  CHECK(guard.state() == AmplifierState::faulted);
  CHECK(guard.fault() == "the amplifier reports a fault");
  CHECK(guard.fault_time_ns() == 5 * ms);
  guard.stop_line(6 * ms, true);
  CHECK(guard.fault() == "the amplifier reports a fault");  // the first cause
  CHECK(guard.clear() == "the amplifier's fault line is still active");
  guard.fault_line(7 * ms, false);
  CHECK(guard.outputs().enable == 0);
  CHECK(guard.clear() == "the stop is still pressed");
  guard.stop_line(8 * ms, false);
  CHECK_FALSE(guard.enable(9 * ms).empty());
  CHECK(guard.clear().empty());
  CHECK(guard.state() == AmplifierState::disarmed);
  CHECK_FALSE(guard.enable(9 * ms).empty());
  CHECK(guard.arm(9 * ms).empty());
}

TEST_CASE("the heartbeat toggles only while both audio and session are alive", "[panel][guard]") {
  Guard guard = enabled_guard();
  const auto toggles = [&guard](std::int64_t from_ms, std::int64_t to_ms, bool audio, bool session) {
    int count = 0, last = guard.outputs().heartbeat;
    for (std::int64_t t = from_ms; t < to_ms; ++t) {
      if (audio) guard.audio_alive(t * ms);
      if (session) guard.session_alive(t * ms);
      guard.tick(t * ms);
      count += guard.outputs().heartbeat != last ? 1 : 0;
      last = guard.outputs().heartbeat;
    }
    return count;
  };
  CHECK(toggles(0, 1000, true, true) == 100);
  SECTION("audio hangs") {
    CHECK(toggles(1000, 3000, false, true) <= 10);
    CHECK(guard.fault() == "the audio thread gives no sign");
    CHECK(guard.outputs().enable == 0);
  }
  SECTION("the session hangs") {
    CHECK(toggles(1000, 6000, true, false) <= 200);
    CHECK(toggles(6000, 8000, true, false) == 0);
    CHECK(guard.fault() == "the session gives no sign");
  }
}

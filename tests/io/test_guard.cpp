#include "station/io/guard.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::io;
using turnpoint::audio::AmplifierState;
using turnpoint::core::FaultKind;

namespace {

constexpr std::int64_t ms = 1'000'000;

/// Returns the reason of a refusal; "" if there was none.
std::string why_not(const std::optional<Guard::Refusal>& refusal) {
  if (!refusal) return "";
  return std::string(name(refusal->kind)) + (refusal->latched ? " latched" : "");
}

void show_life(Guard& guard, std::int64_t now_ns) {
  guard.audio_alive(now_ns);
  guard.session_alive(now_ns);
}

Guard enabled_guard() {
  Guard guard;
  show_life(guard, 0);
  REQUIRE(why_not(guard.arm(0)).empty());
  REQUIRE(why_not(guard.enable(0)).empty());
  return guard;
}

}  // namespace

TEST_CASE("after a start the amplifier is disarmed and cannot be enabled before an operator arms it",
          "[lines][guard]") {
  Guard guard;
  show_life(guard, 0);
  CHECK(guard.state() == AmplifierState::disarmed);
  CHECK(guard.outputs().enable == 0);
  CHECK(why_not(guard.enable(0)) == "disarmed");
  CHECK(why_not(guard.arm(0)).empty());
  CHECK(guard.outputs().enable == 0);
  CHECK(why_not(guard.enable(0)).empty());
  CHECK(guard.outputs().enable == 1);
  guard.disable();
  CHECK(guard.outputs().enable == 0);
  CHECK(guard.state() == AmplifierState::armed);
}

TEST_CASE("the amplifier cannot be armed before the audio thread and the session have reported",
          "[lines][guard]") {
  Guard guard;
  CHECK(why_not(guard.arm(0)) == "audio_silent");
  guard.audio_alive(0);
  CHECK(why_not(guard.arm(0)) == "session_silent");
  guard.session_alive(0);
  CHECK(why_not(guard.arm(0)).empty());
}

TEST_CASE(
    "a fault takes the enable line low and stays latched until its cause is gone and an operator clears it",
    "[lines][guard]") {
  Guard guard = enabled_guard();
  guard.fault_line(5 * ms, true);
  CHECK(guard.outputs().enable == 0);
  CHECK(guard.state() == AmplifierState::faulted);
  CHECK(guard.fault().kind == FaultKind::amplifier);
  CHECK(guard.fault().time_ns == 5 * ms);
  guard.stop_line(6 * ms, true);
  CHECK(guard.fault().kind == FaultKind::amplifier);  // a later cause does not replace the first
  CHECK(why_not(guard.clear()) == "amplifier");
  guard.fault_line(7 * ms, false);
  CHECK(guard.outputs().enable == 0);
  CHECK(why_not(guard.clear()) == "stop_pressed");
  guard.stop_line(8 * ms, false);
  CHECK_FALSE(why_not(guard.enable(9 * ms)).empty());
  CHECK(why_not(guard.clear()).empty());
  CHECK(guard.state() == AmplifierState::disarmed);
  CHECK_FALSE(why_not(guard.enable(9 * ms)).empty());
  CHECK(why_not(guard.arm(9 * ms)).empty());
}

TEST_CASE("the heartbeat toggles only while both the audio thread and the session report", "[lines][guard]") {
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
    CHECK(guard.fault().kind == FaultKind::audio_silent);
    CHECK(guard.outputs().enable == 0);
  }
  SECTION("the session hangs") {
    CHECK(toggles(1000, 6000, true, false) <= 200);
    CHECK(toggles(6000, 8000, true, false) == 0);
    CHECK(guard.fault().kind == FaultKind::session_silent);
  }
}

TEST_CASE("a page that has reported once must go on reporting", "[lines][guard]") {
  Guard guard = enabled_guard();
  for (std::int64_t t = 0; t < 5000; t += 10) {
    show_life(guard, t * ms);
    guard.tick(t * ms);
  }
  CHECK(guard.outputs().enable == 1);  // no page has ever reported, as in a session without a screen
  guard.page_alive(5000 * ms);
  int beats = 0, last = guard.outputs().heartbeat;
  for (std::int64_t t = 5000; t < 9000; t += 10) {
    show_life(guard, t * ms);
    guard.tick(t * ms);
    CHECK(guard.outputs().enable == (t <= 7000 ? 1 : 0));
    beats += t > 7000 && guard.outputs().heartbeat != last ? 1 : 0;
    last = guard.outputs().heartbeat;
  }
  CHECK(beats == 0);
  CHECK(guard.fault().kind == FaultKind::page_silent);
  CHECK(why_not(guard.arm(9000 * ms)) == "page_silent latched");
  CHECK_FALSE(guard.clear());
  CHECK(why_not(guard.arm(9000 * ms)) == "page_silent");
  guard.page_alive(9000 * ms);
  CHECK_FALSE(guard.arm(9000 * ms));
}

TEST_CASE(
    "an enable line that does not follow its command is a fault; if it stays high, the heartbeat ends as "
    "well",
    "[lines][guard]") {
  Guard guard = enabled_guard();
  guard.enable_line(1 * ms, true);
  CHECK(guard.state() == AmplifierState::enabled);
  SECTION("low although driven high") {
    guard.enable_line(2 * ms, false);
    CHECK(guard.fault().kind == FaultKind::enable_line);
    CHECK(guard.outputs().enable == 0);
    guard.enable_line(3 * ms, false);
    CHECK_FALSE(guard.clear());
  }
  SECTION("high although driven low") {
    guard.disable();
    guard.enable_line(2 * ms, true);
    CHECK(guard.fault().kind == FaultKind::enable_line);
    const int heartbeat = guard.outputs().heartbeat;
    for (std::int64_t t = 10; t < 100; t += 10) {
      show_life(guard, t * ms);
      guard.tick(t * ms);
      CHECK(guard.outputs().heartbeat == heartbeat);
    }
    CHECK(why_not(guard.clear()) == "enable_line");
    guard.enable_line(200 * ms, false);
    CHECK_FALSE(guard.clear());
    show_life(guard, 200 * ms);
    guard.tick(200 * ms);
    CHECK(guard.outputs().heartbeat != heartbeat);
  }
}

#include <thread>

#include "station/core/usage_error.hpp"
#include "station/io/amplifier.hpp"
#include "station/io/guarded_amplifier.hpp"
#include "station/io/simulated_lines.hpp"
#include "station/system/clocks.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/shared_lines.hpp"

using namespace turnpoint;
using namespace turnpoint::io;
using audio::AmplifierState;
using core::FaultKind;

namespace {

// Waits up to 5 s until another thread makes the condition true. The limit only ends a test that hangs.
template <typename Condition>
bool eventually(Condition&& condition) {
  const std::int64_t end = system::monotonic_ns() + 5'000'000'000;
  while (!condition()) {
    if (system::monotonic_ns() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

struct Bench {
  std::shared_ptr<SimulatedLines> lines = std::make_shared<SimulatedLines>(SharedLines::count);
  std::unique_ptr<audio::Amplifier> amplifier = guarded(lines);

  void enable() {
    amplifier->audio_alive();
    amplifier->session_alive();
    REQUIRE_FALSE(amplifier->arm());
    REQUIRE_FALSE(amplifier->enable());
  }
};

/// Returns the reason of a refusal; "" if there was none.
std::string why_not(const audio::Amplifier::Refusal& refusal) {
  return refusal ? core::describe(*refusal) : "";
}

}  // namespace

TEST_CASE("the guard thread drops the enable line on a fault edge and latches it",
          "[lines][amplifier][threads]") {
  Bench bench;
  bench.enable();
  CHECK(bench.lines->level(0));
  bench.lines->set(2, true, system::monotonic_ns());
  CHECK(eventually([&] { return bench.amplifier->state() == AmplifierState::faulted; }));
  CHECK_FALSE(bench.lines->level(0));
  CHECK(bench.amplifier->reaction_ns() >= 0);
  CHECK(why_not(bench.amplifier->enable()) ==
        "amplifier reports a fault: the fault is latched; clear it first");
  CHECK(why_not(bench.amplifier->clear()) == "amplifier reports a fault");
  bench.lines->set(2, false, system::monotonic_ns());
  CHECK_FALSE(bench.amplifier->clear());  // clear() reads the line's level, even if no edge was seen
  CHECK(bench.amplifier->state() == AmplifierState::disarmed);
}

TEST_CASE(
    "a stop pressed before the start is noticed, and an audio thread that stops reporting trips the guard",
    "[lines][amplifier][threads]") {
  const auto lines = std::make_shared<SimulatedLines>(SharedLines::count);
  lines->set(SharedLines::stop, true, 0);
  const auto amplifier = guarded(lines);
  amplifier->audio_alive();
  amplifier->session_alive();
  CHECK(why_not(amplifier->arm()) == "emergency stop pressed");
  Bench other;
  other.enable();
  CHECK(eventually([&] { return other.amplifier->state() == AmplifierState::faulted; }));
  CHECK(other.amplifier->fault().kind == FaultKind::audio_silent);
  CHECK_FALSE(other.lines->level(0));
}

TEST_CASE(
    "a GPIO chip that vanishes is a latched fault; after its return only an operator can arm the amplifier",
    "[lines][amplifier][threads]") {
  Bench bench;
  bench.enable();
  bench.lines->remove();
  CHECK(eventually([&] { return bench.amplifier->state() == AmplifierState::faulted; }));
  CHECK(bench.amplifier->fault().kind == FaultKind::lines_gone);
  CHECK(bench.amplifier->fault().detail == "simulated gpio chip: No such device");
  bench.amplifier->disable();
  bench.amplifier->trip(FaultKind::suspended, "another reason");  // a later fault does not replace the first
  CHECK(bench.amplifier->fault().kind == FaultKind::lines_gone);
  CHECK(why_not(bench.amplifier->clear()) == "GPIO lines disconnected: simulated gpio chip: No such device");
  // the stop is pressed while the chip is missing
  bench.lines->set(SharedLines::stop, true, system::monotonic_ns());
  bench.lines->put_back();
  const auto cleared = [&] { return why_not(bench.amplifier->clear()); };
  CHECK(eventually([&] { return cleared() == "emergency stop pressed"; }));
  CHECK(bench.amplifier->state() == AmplifierState::faulted);
  bench.lines->set(SharedLines::stop, false, system::monotonic_ns());
  CHECK(eventually([&] { return cleared().empty(); }));
  CHECK(bench.amplifier->state() == AmplifierState::disarmed);
  CHECK_FALSE(bench.lines->level(SharedLines::enable));
  bench.enable();
  CHECK(bench.lines->level(SharedLines::enable));
}

TEST_CASE("if the chip of one line vanishes, the enable line on another chip goes low",
          "[lines][amplifier][threads]") {
  const int line = GENERATE(int{SharedLines::stop}, int{SharedLines::fault});
  Bench bench;
  bench.enable();
  REQUIRE(bench.lines->level(SharedLines::enable));
  bench.lines->break_line(line);
  CHECK(eventually([&] { return bench.amplifier->state() == AmplifierState::faulted; }));
  CHECK(bench.amplifier->fault().kind == FaultKind::lines_gone);
  const auto driven = bench.lines->driven();
  const auto last = std::find_if(driven.rbegin(), driven.rend(),
                                 [](const auto& one) { return one.line == SharedLines::enable; });
  REQUIRE(last != driven.rend());
  CHECK(last->level == 0);
}

TEST_CASE("an amplifier is opened from the text in the rig file, and every mistake in the text is named",
          "[lines][amplifier]") {
  CHECK(open_amplifier("sim:")->state() == AmplifierState::disarmed);
  CHECK_THROWS_WITH(open_amplifier("gpio:fault=F"), "amplifier 'gpio:fault=F' has no enable line");
  CHECK_THROWS_WITH(open_amplifier("gpio:enable=A,foo=B"),
                    "'gpio:enable=A,foo=B': unknown 'foo'; allowed enable, heartbeat, fault, stop, gate, "
                    "active, fault_active, stop_active, read_back");
  CHECK_THROWS_AS(open_amplifier("gpio:enable=NO_SUCH_LINE"), LineError);
  CHECK_THROWS_AS(open_amplifier("usb:1"), core::UsageError);
  CHECK_THROWS_AS(open_amplifier("nothing"), core::UsageError);
}

TEST_CASE("the simulated amplifier goes through the same states as the real one", "[lines][amplifier]") {
  const auto amplifier = open_amplifier("sim:");
  CHECK(why_not(amplifier->enable()) == "amplifier not armed");
  CHECK(why_not(amplifier->arm()) == "audio thread not responding");
  amplifier->audio_alive();
  CHECK(why_not(amplifier->arm()) == "session not responding");
  amplifier->session_alive();
  CHECK_FALSE(amplifier->arm());
  CHECK_FALSE(amplifier->enable());
  amplifier->trip(FaultKind::suspended, "for 3 s");
  CHECK(amplifier->state() == AmplifierState::faulted);
  CHECK(core::describe(amplifier->fault()) == "machine was suspended: for 3 s");
  CHECK(amplifier->arm());
  CHECK_FALSE(amplifier->clear());
  CHECK(amplifier->state() == AmplifierState::disarmed);
}

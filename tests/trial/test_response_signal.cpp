#include <algorithm>

#include "station/trial/machine.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::trial;

namespace {

constexpr std::int64_t ms = 1'000'000;

/// A trial with a signal 700 ms after the first frame of the exploration, which comes at 500 ms. Answers
/// count for 400 ms.
Machine exploring() {
  Timing plan;
  plan.cue_ns = 500 * ms;
  plan.intervals = {{4000 * ms, {}}};
  plan.answer_ends_stimulus = true;
  plan.signal_ns = plan.anticipation_ns = 700 * ms;
  plan.deadline_ns = 1100 * ms;
  plan.late_ns = 800 * ms;
  plan.iti_ns = 1000 * ms;
  plan.correct = 1;
  Machine machine(plan);
  machine.start(0);
  machine.handle({500 * ms, EventKind::onset, 0});
  machine.handle({500 * ms, EventKind::tick, 0});
  return machine;
}

bool signals(const std::vector<Action>& actions) {
  return std::any_of(actions.begin(), actions.end(),
                     [](const Action& action) { return action.kind == ActionKind::signal; });
}

}  // namespace

TEST_CASE("a response signal is given once, at its time after the zero, and answers count from it on",
          "[trial]") {
  auto machine = exploring();
  CHECK(machine.wake_ns() == 1200 * ms);
  CHECK_FALSE(signals(machine.handle({1199 * ms, EventKind::tick, 0})));
  CHECK_FALSE(machine.signalled());
  const auto actions = machine.handle({1203 * ms, EventKind::tick, 0});
  REQUIRE(signals(actions));
  CHECK(actions.front().time_ns == 1200 * ms);
  CHECK(machine.signalled());
  CHECK_FALSE(signals(machine.handle({1210 * ms, EventKind::tick, 0})));

  SECTION("an answer within the window counts") {
    machine.handle({1600 * ms, EventKind::answer, 1});
    CHECK(machine.result().outcome == Outcome::answered);
    CHECK(machine.result().response_time_ns == 1100 * ms);
  }
  SECTION("an answer that was given before the signal arrives late") {
    machine.handle({1190 * ms, EventKind::answer, 1});
    CHECK(machine.result().outcome == Outcome::anticipation);
  }
  SECTION("after the window it is too late") {
    machine.handle({1700 * ms, EventKind::tick, 0});
    CHECK(machine.result().outcome == Outcome::timeout);
  }
}

TEST_CASE("after an answer before the signal there is no signal", "[trial]") {
  auto machine = exploring();
  machine.handle({900 * ms, EventKind::answer, 1});
  CHECK(machine.result().outcome == Outcome::anticipation);
  CHECK_FALSE(signals(machine.handle({1400 * ms, EventKind::tick, 0})));
}

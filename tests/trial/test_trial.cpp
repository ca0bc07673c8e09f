#include <random>

#include "station/trial/trial.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::trial;

namespace {

constexpr std::int64_t ms = 1'000'000;

Plan exploration() {
  Plan plan;
  plan.cue_ns = 500 * ms;
  plan.intervals = {{4000 * ms, {}}};
  plan.answer_ends_stimulus = true;
  plan.deadline_ns = 6000 * ms;
  plan.anticipation_ns = 150 * ms;
  plan.late_ns = 800 * ms;
  plan.iti_ns = 1000 * ms;
  plan.correct = 1;
  return plan;
}

Plan two_intervals() {
  Plan plan;
  plan.intervals = {{1500 * ms, {}}, {1500 * ms, {}}};
  plan.gap_ns = 1000 * ms;
  plan.response_zero = ResponseZero::interval_off;
  plan.deadline_ns = 3000 * ms;
  plan.iti_ns = 800 * ms;
  plan.correct = 0;
  return plan;
}

bool has(const std::vector<Action>& actions, ActionKind kind, int value) {
  for (const auto& action : actions)
    if (action.kind == kind && action.value == value) return true;
  return false;
}
bool enters(const std::vector<Action>& actions, Phase phase) {
  return has(actions, ActionKind::enter, static_cast<int>(phase));
}

/// Starts at 0 and takes the machine to the exploration's first frame at 500 ms.
Machine exploring(const Plan& plan = exploration()) {
  Machine machine(plan);
  machine.start(0);
  machine.handle({500 * ms, EventKind::tick, 0});
  machine.handle({500 * ms, EventKind::onset, 0});
  return machine;
}

}  // namespace

TEST_CASE("an exploration runs cue, stimulus, answer, interval, and counts from the go cue", "[trial]") {
  Machine machine(exploration());
  CHECK(enters(machine.start(0), Phase::cue));
  CHECK(machine.wake_ns() == 500 * ms);
  const auto asked = machine.handle({500 * ms, EventKind::tick, 0});
  CHECK(has(asked, ActionKind::present, 0));
  CHECK(enters(machine.handle({500 * ms, EventKind::onset, 0}), Phase::stimulus));
  CHECK(machine.answers_open());
  const auto answered = machine.handle({1700 * ms, EventKind::answer, 1});
  CHECK(has(answered, ActionKind::silence, 0));
  CHECK(enters(answered, Phase::interval));
  machine.handle({2700 * ms, EventKind::tick, 0});
  REQUIRE(machine.done());
  CHECK(machine.result().outcome == Outcome::answered);
  CHECK(machine.result().correct == true);
  CHECK(machine.result().response_time_ns == 1200 * ms);
  CHECK(machine.result().ended_ns == 2700 * ms);
}

TEST_CASE("an onset in the future starts the interval at its own time, not when the message came",
          "[trial]") {
  Machine machine(exploration());
  machine.start(0);
  machine.handle({510 * ms, EventKind::tick, 0});
  machine.handle({530 * ms, EventKind::onset, 0});
  CHECK(machine.phase() == Phase::onset);
  CHECK(machine.wake_ns() == 530 * ms);
  machine.handle({600 * ms, EventKind::tick, 0});
  REQUIRE(machine.phase() == Phase::stimulus);
  CHECK(machine.result().zero_ns == 530 * ms);
}

TEST_CASE("a deadline is decided by time stamps, and an answer on its last millisecond still counts",
          "[trial]") {
  auto machine = exploring();
  machine.handle({6510 * ms, EventKind::tick, 0});
  CHECK_FALSE(machine.done());
  SECTION("stamped at the deadline, delivered after it") {
    machine.handle({6500 * ms, EventKind::answer, 0});
    CHECK(machine.result().outcome == Outcome::answered);
    CHECK(machine.result().response_time_ns == 6000 * ms);
  }
  SECTION("stamped one nanosecond later") {
    machine.handle({6500 * ms + 1, EventKind::answer, 0});
    const auto actions = machine.handle({6520 * ms, EventKind::tick, 0});
    CHECK(enters(actions, Phase::late));
    CHECK(machine.result().outcome == Outcome::timeout);
    CHECK_FALSE(machine.result().response.has_value());
    CHECK_FALSE(machine.result().response_time_ns.has_value());
    CHECK(machine.result().extra_touches == 1);
  }
}

TEST_CASE("after the exploration the surface is silent and the answer still counts until the deadline",
          "[trial]") {
  auto machine = exploring();
  CHECK(enters(machine.handle({4500 * ms, EventKind::tick, 0}), Phase::response));
  machine.handle({5000 * ms, EventKind::answer, 0});
  CHECK(machine.result().correct == false);
  CHECK(machine.result().response_time_ns == 4500 * ms);
}

TEST_CASE("an answer before the stimulus or after another is logged and never scored", "[trial]") {
  Machine machine(exploration());
  machine.start(0);
  machine.handle({100 * ms, EventKind::answer, 0});
  CHECK(machine.phase() == Phase::cue);
  machine.handle({500 * ms, EventKind::tick, 0});
  machine.handle({500 * ms, EventKind::onset, 0});
  machine.handle({1000 * ms, EventKind::answer, 1});
  machine.handle({1001 * ms, EventKind::answer, 0});
  CHECK(machine.result().response == 1);
  CHECK(machine.result().extra_touches == 2);
}

TEST_CASE("an answer sooner than a person can feel is an anticipation without a response", "[trial]") {
  auto machine = exploring();
  CHECK(enters(machine.handle({649 * ms, EventKind::answer, 1}), Phase::late));
  CHECK(machine.result().outcome == Outcome::anticipation);
  CHECK_FALSE(machine.result().response.has_value());
}

TEST_CASE("two intervals are presented in turn and answers open at the end of the second", "[trial]") {
  Machine machine(two_intervals());
  CHECK(has(machine.start(0), ActionKind::present, 0));
  machine.handle({10 * ms, EventKind::onset, 0});
  machine.handle({500 * ms, EventKind::answer, 0});
  CHECK(enters(machine.handle({1510 * ms, EventKind::tick, 0}), Phase::gap));
  CHECK(has(machine.handle({2510 * ms, EventKind::tick, 0}), ActionKind::present, 1));
  machine.handle({2520 * ms, EventKind::onset, 1});
  machine.handle({3000 * ms, EventKind::answer, 0});
  CHECK_FALSE(machine.result().response.has_value());
  CHECK(enters(machine.handle({4020 * ms, EventKind::tick, 0}), Phase::response));
  machine.handle({4300 * ms, EventKind::answer, 0});
  CHECK(machine.result().response_time_ns == 280 * ms);
  CHECK(machine.result().extra_touches == 2);
  CHECK(machine.result().correct == true);
}

TEST_CASE("a change under the finger counts from the change, and an answer before it anticipates",
          "[trial]") {
  auto plan = exploration();
  plan.intervals = {{5000 * ms, {1500 * ms}}};
  plan.response_zero = ResponseZero::change;
  plan.deadline_ns = 800 * ms;
  SECTION("after the change") {
    auto machine = exploring(plan);
    machine.handle({2600 * ms, EventKind::answer, 0});
    CHECK(machine.result().response_time_ns == 600 * ms);
  }
  SECTION("before the change") {
    auto machine = exploring(plan);
    machine.handle({1900 * ms, EventKind::answer, 0});
    CHECK(machine.result().outcome == Outcome::anticipation);
  }
  SECTION("not in time: the stimulus ends with the deadline") {
    auto machine = exploring(plan);
    const auto actions = machine.handle({2820 * ms, EventKind::tick, 0});
    CHECK(has(actions, ActionKind::silence, 0));
    CHECK(machine.result().outcome == Outcome::timeout);
  }
}

TEST_CASE("deciding and reaching are told apart where the finger's contact is known", "[trial]") {
  auto machine = exploring();
  machine.handle({600 * ms, EventKind::contact, 1});
  machine.handle({1500 * ms, EventKind::contact, 0});
  machine.handle({1900 * ms, EventKind::answer, 1});
  CHECK(machine.result().decision_time_ns == 1000 * ms);
  CHECK(machine.result().movement_time_ns == 400 * ms);
}

TEST_CASE("with first contact as zero nothing counts before the finger arrives", "[trial]") {
  auto plan = exploration();
  plan.response_zero = ResponseZero::first_contact;
  auto machine = exploring(plan);
  machine.handle({900 * ms, EventKind::contact, 1});
  machine.handle({1900 * ms, EventKind::answer, 1});
  CHECK(machine.result().response_time_ns == 1000 * ms);
  auto untouched = exploring(plan);
  untouched.handle({10520 * ms, EventKind::tick, 0});
  CHECK(untouched.result().outcome == Outcome::timeout);
}

TEST_CASE("an underrun or a fault during a stimulus voids the trial, and silence is ordered", "[trial]") {
  auto machine = exploring();
  const auto kind = GENERATE(EventKind::xrun, EventKind::fault);
  const auto actions = machine.handle({900 * ms, kind, 0});
  CHECK(has(actions, ActionKind::silence, 0));
  CHECK(machine.done());
  CHECK(machine.result().outcome == Outcome::fault);
  CHECK_FALSE(machine.result().response.has_value());
}

TEST_CASE("stopping after the answer keeps the answer", "[trial]") {
  auto machine = exploring();
  machine.handle({1500 * ms, EventKind::answer, 1});
  machine.handle({1600 * ms, EventKind::abort, 0});
  CHECK(machine.done());
  CHECK(machine.result().outcome == Outcome::answered);
}

TEST_CASE("a plan that cannot run is refused with what is wrong", "[trial]") {
  auto plan = exploration();
  SECTION("no interval") { plan.intervals.clear(); }
  SECTION("no answers") { plan.answers = 0; }
  SECTION("right answer is none of them") { plan.correct = 2; }
  SECTION("negative time") { plan.iti_ns = -1; }
  SECTION("no change to count from") { plan.response_zero = ResponseZero::change; }
  CHECK_THROWS_AS(Machine(plan), std::invalid_argument);
}

TEST_CASE("whatever comes in whatever order, the invariants of a trial hold", "[trial]") {
  std::mt19937_64 random(20261121);
  const auto below = [&](std::uint64_t n) { return static_cast<std::int64_t>(random() % n); };
  for (int sequence = 0; sequence < 100'000; ++sequence) {
    auto plan = below(2) ? exploration() : two_intervals();
    if (plan.answer_ends_stimulus && below(3) == 0) {
      plan.intervals[0].scene_starts_ns = {1000 * ms};
      plan.response_zero = ResponseZero::change;
    } else if (below(4) == 0) {
      plan.response_zero = below(2) ? ResponseZero::first_contact : ResponseZero::lift_off;
    }
    Machine machine(plan);
    std::int64_t now = 0;
    auto actions = machine.start(now);
    int presented = 0, silenced = 0;
    for (int event = 0; event < 60 && !machine.done(); ++event) {
      for (const auto& action : actions) {
        if (action.kind == ActionKind::present) {
          ++presented;
          machine.handle({now + below(40) * ms, EventKind::onset, action.value});
        }
        if (action.kind == ActionKind::silence) ++silenced;
      }
      now += below(5) == 0 ? below(4000) * ms : below(50) * ms;
      const auto kind = static_cast<EventKind>(below(60) == 0 ? 5 + below(3) : below(2) ? 0 : 2 + below(3));
      actions = machine.handle({now, kind, static_cast<int>(below(4)) - 1});
    }
    if (!machine.done()) {
      for (int tick = 0; tick < 30 && !machine.done(); ++tick) {
        for (const auto& action : actions)
          if (action.kind == ActionKind::present) {
            ++presented;
            machine.handle({now, EventKind::onset, action.value});
          }
        const auto wake = machine.wake_ns();
        if (!wake) {
          actions.clear();
          break;
        }
        now = std::max(now, *wake);
        actions = machine.handle({now, EventKind::tick, 0});
      }
    }
    const auto& result = machine.result();
    const bool answered = machine.done() && result.outcome == Outcome::answered;
    if (!machine.done()) FAIL("a trial that time alone does not end, sequence " << sequence);
    if (answered != result.response.has_value())
      FAIL("response without answered, sequence " << sequence << " " << name(result.outcome) << " "
                                                  << result.response.has_value());
    if (answered != result.response_time_ns.has_value()) FAIL("time without answer, sequence " << sequence);
    if (result.correct && !answered) FAIL("a score without an answer");
    if (answered &&
        (*result.response_time_ns < plan.anticipation_ns || *result.response_time_ns > plan.deadline_ns))
      FAIL("response time outside anticipation and deadline");
    if (presented > static_cast<int>(plan.intervals.size())) FAIL("an interval presented twice");
    if (result.outcome == Outcome::answered && !answered) FAIL("answered but not done");
  }
  SUCCEED();
}

#include "tests/support/catch.hpp"
#include "tests/trial/timings.hpp"

using namespace trial_test;

TEST_CASE("an exploration consists of cue, stimulus, answer and pause, and times count from the go cue",
          "[trial]") {
  Machine machine(exploration());
  const auto asked = machine.start(0);
  CHECK(enters(asked, Phase::cue));
  CHECK(has(asked, ActionKind::present, 0));
  CHECK_FALSE(machine.wake_ns());  // the next wake-up time is unknown before the onset
  machine.handle({10 * ms, EventKind::tick, 0});
  CHECK_FALSE(enters(machine.handle({500 * ms, EventKind::onset, 0}), Phase::stimulus));
  CHECK(machine.wake_ns() == 500 * ms);
  CHECK(enters(machine.handle({500 * ms, EventKind::tick, 0}), Phase::stimulus));
  CHECK(machine.answers_open());
  const auto answered = machine.handle({1700 * ms, EventKind::answer, 1});
  CHECK(has(answered, ActionKind::silence, 0));
  CHECK(enters(answered, Phase::interval));
  CHECK_FALSE(machine.decided());
  machine.handle({1760 * ms, EventKind::heard, 0});
  CHECK(machine.decided());
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
  CHECK(machine.phase() == Phase::cue);
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

TEST_CASE("an answer before the stimulus, or after another answer, is logged but never scored", "[trial]") {
  Machine machine(exploration());
  machine.start(0);
  machine.handle({500 * ms, EventKind::onset, 0});
  machine.handle({100 * ms, EventKind::answer, 0});
  CHECK(machine.phase() == Phase::cue);
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

TEST_CASE("the pause is longer after an answer that was not right, by the delay of its kind", "[trial]") {
  auto plan = exploration();
  plan.wrong_delay_ns = 2000 * ms, plan.late_delay_ns = 4000 * ms, plan.early_delay_ns = 3000 * ms;
  plan.answers = 3, plan.unsure = 2;
  const auto pause = [&](std::optional<Event> event) {
    auto machine = exploring(plan);
    machine.handle({600 * ms, EventKind::heard, 0});
    const std::int64_t at = event ? event->time_ns : 6500 * ms + plan.watermark_ns;
    machine.handle(event.value_or(Event{at, EventKind::tick, 0}));
    if (machine.phase() == Phase::late) machine.handle({at + plan.late_ns, EventKind::tick, 0});
    REQUIRE(machine.phase() == Phase::interval);
    machine.handle({machine.wake_ns().value(), EventKind::tick, 0});
    CHECK(machine.done());
    return machine.result().ended_ns - at - (event && machine.result().response ? 0 : plan.late_ns);
  };
  CHECK(pause(Event{900 * ms, EventKind::answer, 1}) == 1000 * ms);
  CHECK(pause(Event{900 * ms, EventKind::answer, 0}) == 3000 * ms);
  CHECK(pause(Event{900 * ms, EventKind::answer, 2}) == 1000 * ms);  // unsure: neither right nor wrong
  CHECK(pause(Event{600 * ms, EventKind::answer, 1}) == 4000 * ms);  // too early
  CHECK(pause({}) == 5000 * ms);
  plan.wrong_delay_ns = -1;
  CHECK_THROWS_AS(Machine(plan), std::invalid_argument);
}

TEST_CASE("two intervals are presented in turn and answers open at the end of the second", "[trial]") {
  Machine machine(two_intervals());
  CHECK(has(machine.start(0), ActionKind::present, 0));
  machine.handle({10 * ms, EventKind::onset, 0});
  machine.handle({2520 * ms, EventKind::onset, 1});  // this onset is reported in advance
  machine.handle({500 * ms, EventKind::answer, 0});
  CHECK(enters(machine.handle({1510 * ms, EventKind::tick, 0}), Phase::gap));
  CHECK(machine.wake_ns() == 2520 * ms);
  CHECK(enters(machine.handle({2520 * ms, EventKind::tick, 0}), Phase::stimulus));
  machine.handle({3000 * ms, EventKind::answer, 0});
  CHECK_FALSE(machine.result().response.has_value());
  CHECK(enters(machine.handle({4020 * ms, EventKind::tick, 0}), Phase::response));
  machine.handle({4300 * ms, EventKind::answer, 0});
  CHECK(machine.result().response_time_ns == 280 * ms);
  CHECK(machine.result().extra_touches == 2);
  CHECK(machine.result().correct == true);
}

TEST_CASE("response times count from a change under the finger, and an earlier answer is an anticipation",
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

TEST_CASE("decision and movement time are separated if the finger's contact is known", "[trial]") {
  auto machine = exploring();
  machine.handle({600 * ms, EventKind::contact, 1});
  machine.handle({1500 * ms, EventKind::contact, 0});
  machine.handle({1900 * ms, EventKind::answer, 1});
  CHECK(machine.result().decision_time_ns == 1000 * ms);
  CHECK(machine.result().movement_time_ns == 400 * ms);
}

TEST_CASE("if response_zero is the first contact, no answer counts before the finger arrives", "[trial]") {
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

TEST_CASE("lost frames of a stimulus, or a fault, make the trial void at once and silence the surface",
          "[trial]") {
  auto machine = exploring();
  const auto kind = GENERATE(EventKind::xrun, EventKind::fault);
  const auto actions = machine.handle({900 * ms, kind, 1});
  CHECK(has(actions, ActionKind::silence, 0));
  CHECK(machine.done());
  CHECK(machine.result().outcome == Outcome::fault);
  CHECK_FALSE(machine.result().response.has_value());
}

TEST_CASE("lost frames of silence are counted, but do not make the trial void", "[trial]") {
  auto machine = exploring();
  CHECK(machine.handle({900 * ms, EventKind::xrun, 0}).empty());
  CHECK(machine.result().xruns == 1);
  CHECK(machine.phase() == Phase::stimulus);
}

TEST_CASE("lost frames that are reported after the stimulus, or after the answer, still make the trial void",
          "[trial]") {
  SECTION("in the pause that follows") {
    Machine machine(two_intervals());
    machine.start(0);
    machine.handle({10 * ms, EventKind::onset, 0});
    machine.handle({2510 * ms, EventKind::onset, 1});
    const auto actions = machine.handle({1511 * ms, EventKind::xrun, 1});
    CHECK(has(actions, ActionKind::silence, 0));  // this cancels the second interval
    CHECK(machine.done());
    CHECK(machine.interval() == 0);
    CHECK(machine.result().outcome == Outcome::fault);
  }
  SECTION("after the answer, whatever was shown") {
    auto machine = answered_after_two();
    CHECK_FALSE(machine.decided());
    CHECK(machine.result().response == 0);
    machine.handle({4311 * ms, EventKind::xrun, 1});
    CHECK(machine.done());
    CHECK(machine.result().outcome == Outcome::fault);
    CHECK_FALSE(machine.result().response.has_value());
    CHECK_FALSE(machine.result().correct.has_value());
    CHECK_FALSE(machine.result().response_time_ns.has_value());
  }
  SECTION("not once all of it has been heard") {
    auto machine = answered_after_two();
    machine.handle({4312 * ms, EventKind::heard, 1});
    CHECK(machine.decided());
    machine.handle({4313 * ms, EventKind::xrun, 0});
    CHECK(machine.result().outcome == Outcome::answered);
  }
}

TEST_CASE("a trial does not end before its last frame has been played", "[trial]") {
  auto machine = answered_after_two();
  machine.handle({9000 * ms, EventKind::tick, 0});
  CHECK_FALSE(machine.done());
  CHECK_FALSE(
      machine
          .wake_ns());  // the machine waits for `heard` (all of the stimulus has been played), not for a time
  machine.handle({9010 * ms, EventKind::heard, 1});
  CHECK(machine.done());
  CHECK(machine.result().outcome == Outcome::answered);
  CHECK(machine.result().ended_ns == (4310 + 800) * ms);
}

TEST_CASE("after a fault before the last frame was played, the answer has no proof and the trial is void",
          "[trial]") {
  auto machine = answered_after_two();
  machine.handle({4311 * ms, EventKind::fault, 0});
  CHECK(machine.done());
  CHECK(machine.result().outcome == Outcome::fault);
}

TEST_CASE("a stop before the intervals, or between them, cancels what has not begun", "[trial]") {
  Machine machine(two_intervals());
  machine.start(0);
  machine.handle({100 * ms, EventKind::onset, 0});
  machine.handle({2600 * ms, EventKind::onset, 1});
  const auto at = GENERATE(50, 2000);
  CHECK(has(machine.handle({at * ms, EventKind::abort, 0}), ActionKind::silence, 0));
  CHECK(machine.done());
}

TEST_CASE("stopping after the answer keeps the answer", "[trial]") {
  auto machine = exploring();
  machine.handle({1500 * ms, EventKind::answer, 1});
  machine.handle({1600 * ms, EventKind::abort, 0});
  CHECK_FALSE(machine.done());  // the machine waits for `heard`: all of the stimulus has been played
  machine.handle({1610 * ms, EventKind::heard, 0});
  CHECK(machine.done());
  CHECK(machine.result().outcome == Outcome::answered);
}

TEST_CASE("an impossible plan is refused, and the message says what is wrong", "[trial]") {
  auto plan = exploration();
  SECTION("no interval") { plan.intervals.clear(); }
  SECTION("no answers") { plan.answers = 0; }
  SECTION("right answer is none of them") { plan.correct = 2; }
  SECTION("negative time") { plan.iti_ns = -1; }
  SECTION("no change to count from") { plan.response_zero = ResponseZero::change; }
  CHECK_THROWS_AS(Machine(plan), std::invalid_argument);
}

TEST_CASE("confidence is asked for after an answer, and completes the trial", "[trial]") {
  auto plan = exploration();
  plan.confidence = 4;
  auto machine = exploring(plan);
  const auto answered = machine.handle({1500 * ms, EventKind::answer, 1});
  CHECK(enters(answered, Phase::confidence));
  CHECK(has(answered, ActionKind::silence, 0));
  CHECK_FALSE(machine.wake_ns());  // the confidence rating has no deadline
  machine.handle({1500 * ms, EventKind::heard, 0});
  CHECK_FALSE(machine.decided());
  // this touch began before the answer, so it does not count as a confidence rating
  machine.handle({1400 * ms, EventKind::answer, 2});
  // index 4 does not exist, because there are only four degrees of confidence
  machine.handle({1600 * ms, EventKind::answer, 4});
  CHECK_FALSE(machine.result().confidence);
  CHECK(machine.result().extra_touches == 2);
  CHECK(enters(machine.handle({20'000 * ms, EventKind::answer, 2}), Phase::interval));
  REQUIRE(machine.decided());
  CHECK(machine.result().outcome == Outcome::answered);
  CHECK(machine.result().response == 1);
  CHECK(machine.result().response_time_ns == 1000 * ms);
  CHECK(machine.result().confidence == 3);
  CHECK(machine.result().confidence_time_ns == 18'500 * ms);
}

TEST_CASE("a second press soon after the answer is never its confidence", "[trial]") {
  for (const auto after : {0 * ms, 1 * ms, 150 * ms, 349 * ms}) {
    auto plan = exploration();
    plan.confidence = 4;
    auto machine = exploring(plan);
    machine.handle({1500 * ms, EventKind::answer, 1});
    machine.handle({1500 * ms + after, EventKind::answer, 1});
    CHECK_FALSE(machine.result().confidence);
    CHECK(machine.phase() == Phase::confidence);
    CHECK(machine.result().extra_touches == 1);
    machine.handle({1850 * ms, EventKind::answer, 1});
    CHECK(machine.result().confidence == 2);
  }
}

TEST_CASE("no confidence is asked for after a timeout, and a void trial has none", "[trial]") {
  auto plan = exploration();
  plan.confidence = 4;
  auto late = exploring(plan);
  late.handle({4500 * ms, EventKind::tick, 0});
  CHECK(enters(late.handle({6520 * ms, EventKind::tick, 0}), Phase::late));
  auto refuted = exploring(plan);
  refuted.handle({1500 * ms, EventKind::answer, 1});
  refuted.handle({1700 * ms, EventKind::refuted, 0});
  CHECK(refuted.done());
  CHECK(refuted.result().outcome == Outcome::fault);
  CHECK_FALSE(refuted.result().response);
  auto stopped = exploring(plan);
  stopped.handle({1500 * ms, EventKind::answer, 1});
  stopped.handle({1700 * ms, EventKind::abort, 0});
  CHECK(stopped.result().outcome == Outcome::aborted);
  CHECK_FALSE(stopped.result().confidence);
}

TEST_CASE("a trial with another movement than the one asked for is void, and the page says why", "[trial]") {
  auto machine = exploring();
  machine.handle({1500 * ms, EventKind::answer, 1});
  const auto actions = machine.handle({1600 * ms, EventKind::outside, 0});
  CHECK(enters(actions, Phase::late));
  CHECK(machine.result().outcome == Outcome::fault);
  CHECK_FALSE(machine.result().response);
  CHECK_FALSE(machine.decided());  // it still waits for `heard`
  machine.handle({1610 * ms, EventKind::heard, 0});
  CHECK(machine.decided());
  machine.handle({9000 * ms, EventKind::tick, 0});
  CHECK(machine.done());
  CHECK(machine.result().outcome == Outcome::fault);
}

TEST_CASE("before the answer, such a trial ends the question; after a timeout it changes nothing",
          "[trial]") {
  auto waiting = exploring();
  CHECK(enters(waiting.handle({1600 * ms, EventKind::outside, 0}), Phase::late));
  waiting.handle({1700 * ms, EventKind::answer, 1});
  CHECK(waiting.result().outcome == Outcome::fault);
  CHECK_FALSE(waiting.result().response);
  auto late = exploring();
  late.handle({9000 * ms, EventKind::tick, 0});
  late.handle({9001 * ms, EventKind::outside, 0});
  CHECK(late.result().outcome == Outcome::timeout);
}

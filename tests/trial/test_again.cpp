// Trials whose intervals the participant may ask for again.
#include "tests/support/catch.hpp"
#include "tests/trial/timings.hpp"

using namespace trial_test;

namespace {

constexpr int present = 0;

/// Two intervals of which nobody has answered yet: they end at 4010 ms, and both were played.
Machine heard_two(int again, Timing plan = two_intervals()) {
  plan.again = again;
  Machine machine(plan);
  machine.start(0);
  machine.handle({10 * ms, EventKind::onset, 0});
  machine.handle({2510 * ms, EventKind::onset, 1});
  machine.handle({1520 * ms, EventKind::heard, 0});
  machine.handle({4020 * ms, EventKind::heard, 1});
  return machine;
}

/// Presents the two intervals again, the first at `onset_ns`, and plays them to their end.
void hear_again(Machine& machine, std::int64_t onset_ns) {
  machine.handle({onset_ns, EventKind::onset, 0});
  machine.handle({onset_ns + 2500 * ms, EventKind::onset, 1});
  machine.handle({onset_ns + 1510 * ms, EventKind::heard, 0});
  machine.handle({onset_ns + 4010 * ms, EventKind::heard, 1});
}

}  // namespace

TEST_CASE("intervals that are asked for again are presented as before, and times count from the last time",
          "[trial][again]") {
  auto plan = two_intervals();
  plan.cue_ns = 500 * ms;
  plan.anticipation_ns = 150 * ms;
  auto machine = heard_two(2, plan);
  REQUIRE(machine.phase() == Phase::response);
  CHECK(machine.may_ask_again());
  const auto asked = machine.handle({5000 * ms, EventKind::again, 0});
  CHECK(enters(asked, Phase::cue));
  CHECK(has(asked, ActionKind::present, present));
  CHECK(asked.back().time_ns == 5500 * ms);
  CHECK_FALSE(has(asked, ActionKind::silence, 1));  // nothing was playing
  CHECK(machine.result().again == 1);
  CHECK(machine.interval() == 0);
  CHECK_FALSE(machine.wake_ns());  // the deadline of the first presentation is gone
  machine.handle({9000 * ms, EventKind::tick, 0});
  CHECK(machine.phase() == Phase::cue);
  machine.handle({9500 * ms, EventKind::onset, 0});
  machine.handle({12000 * ms, EventKind::onset, 1});
  CHECK(enters(machine.handle({9500 * ms, EventKind::tick, 0}), Phase::stimulus));
  CHECK(machine.interval() == 0);
  CHECK(enters(machine.handle({11000 * ms, EventKind::tick, 0}), Phase::gap));
  CHECK(enters(machine.handle({12000 * ms, EventKind::tick, 0}), Phase::stimulus));
  CHECK(machine.interval() == 1);
  machine.handle({13000 * ms, EventKind::answer, 0});  // before the end of the second interval
  CHECK_FALSE(machine.result().response);
  machine.handle({13500 * ms, EventKind::tick, 0});
  SECTION("an answer") {
    machine.handle({13900 * ms, EventKind::answer, 0});
    CHECK(machine.result().response_time_ns == 400 * ms);
    CHECK(machine.result().zero_ns == 13500 * ms);
    CHECK_FALSE(machine.decided());  // the second presentation has not been reported as heard
    machine.handle({13910 * ms, EventKind::heard, 0});
    CHECK_FALSE(machine.decided());
    machine.handle({13920 * ms, EventKind::heard, 1});
    CHECK(machine.decided());
    CHECK(machine.result().outcome == Outcome::answered);
    CHECK(machine.result().extra_touches == 1);
  }
  SECTION("an answer too early") {
    machine.handle({13600 * ms, EventKind::answer, 0});
    CHECK(machine.result().outcome == Outcome::anticipation);
  }
  SECTION("no answer until the deadline, which has begun again") {
    CHECK(machine.wake_ns() == 16500 * ms + plan.watermark_ns);
    machine.handle({16500 * ms + plan.watermark_ns, EventKind::tick, 0});
    CHECK(machine.result().outcome == Outcome::timeout);
    CHECK(machine.result().again == 1);
  }
}

TEST_CASE("the intervals come again at most as often as the task says, and never after answer or deadline",
          "[trial][again]") {
  SECTION("no more than allowed") {
    auto machine = heard_two(2);
    for (int i = 0; i < 2; ++i) {
      machine.handle({(5000 + 6000 * i) * ms, EventKind::again, 0});
      hear_again(machine, (6000 + 6000 * i) * ms);
    }
    REQUIRE(machine.phase() == Phase::response);
    CHECK_FALSE(machine.may_ask_again());
    CHECK_FALSE(has(machine.handle({16100 * ms, EventKind::again, 0}), ActionKind::present, present));
    CHECK(machine.result().again == 2);
    CHECK(machine.result().extra_touches == 1);
    machine.handle({16200 * ms, EventKind::answer, 0});
    CHECK(machine.result().outcome == Outcome::answered);
  }
  SECTION("not in a task without them") {
    auto machine = heard_two(0);
    CHECK_FALSE(machine.may_ask_again());
    CHECK_FALSE(has(machine.handle({5000 * ms, EventKind::again, 0}), ActionKind::present, present));
    CHECK(machine.phase() == Phase::response);
    CHECK(machine.result().extra_touches == 1);
  }
  SECTION("not before the answers are open") {
    auto plan = two_intervals();
    plan.again = 1;
    Machine machine(plan);
    machine.start(0);
    machine.handle({10 * ms, EventKind::onset, 0});
    CHECK_FALSE(has(machine.handle({1000 * ms, EventKind::again, 0}), ActionKind::present, present));
    CHECK(machine.result().again == 0);
  }
  SECTION("not after the answer") {
    auto machine = heard_two(1);
    machine.handle({4500 * ms, EventKind::answer, 0});
    CHECK_FALSE(has(machine.handle({4600 * ms, EventKind::again, 0}), ActionKind::present, present));
    CHECK(machine.result().response == 0);
  }
  SECTION("a stamp after the deadline, before the deadline is decided") {
    auto machine = heard_two(1);
    CHECK_FALSE(has(machine.handle({7010 * ms + 1, EventKind::again, 0}), ActionKind::present, present));
    machine.handle({7100 * ms, EventKind::tick, 0});
    CHECK(machine.result().outcome == Outcome::timeout);
  }
  SECTION("a stamp on the deadline, delivered after it") {
    auto machine = heard_two(1);
    machine.handle({7015 * ms, EventKind::tick, 0});
    CHECK(has(machine.handle({7010 * ms, EventKind::again, 0}), ActionKind::present, present));
  }
}

TEST_CASE("intervals are presented again only once those before are known to have been played",
          "[trial][again]") {
  auto plan = two_intervals();
  plan.again = 1;
  Machine machine(plan);
  machine.start(0);
  machine.handle({10 * ms, EventKind::onset, 0});
  machine.handle({2510 * ms, EventKind::onset, 1});
  machine.handle({1520 * ms, EventKind::heard, 0});
  machine.handle({4010 * ms, EventKind::tick, 0});
  const auto asked = machine.handle({4050 * ms, EventKind::again, 0});
  CHECK(enters(asked, Phase::cue));
  CHECK_FALSE(has(asked, ActionKind::present, present));
  SECTION("played") {
    CHECK(has(machine.handle({4120 * ms, EventKind::heard, 1}), ActionKind::present, present));
    hear_again(machine, 5000 * ms);
    machine.handle({9500 * ms, EventKind::answer, 0});
    CHECK(machine.result().response_time_ns == 500 * ms);
    CHECK(machine.decided());
  }
  SECTION("refuted: the trial is void") {
    machine.handle({4120 * ms, EventKind::refuted, 1});
    CHECK(machine.done());
    CHECK(machine.result().outcome == Outcome::fault);
  }
  SECTION("the finger did not move as asked: the trial is void, and nothing is presented again") {
    machine.handle({4120 * ms, EventKind::outside, 0});
    CHECK_FALSE(has(machine.handle({4120 * ms, EventKind::heard, 1}), ActionKind::present, present));
    CHECK(machine.result().outcome == Outcome::fault);
    machine.handle({10000 * ms, EventKind::tick, 0});
    CHECK(machine.done());
  }
}

TEST_CASE("a fault, a stop or lost frames in a later presentation end the trial as in the first",
          "[trial][again]") {
  auto machine = heard_two(3);
  machine.handle({5000 * ms, EventKind::again, 0});
  const auto kind = GENERATE(EventKind::xrun, EventKind::fault, EventKind::abort, EventKind::refuted);
  SECTION("in the cue") {}
  SECTION("in the second interval") {
    machine.handle({6000 * ms, EventKind::onset, 0});
    machine.handle({8500 * ms, EventKind::onset, 1});
    machine.handle({9000 * ms, EventKind::tick, 0});
    REQUIRE(machine.interval() == 1);
  }
  const auto cut = machine.handle({9100 * ms, kind, 1});
  CHECK(machine.done());
  CHECK(has(cut, ActionKind::silence, machine.interval()));
  CHECK(machine.result().outcome == (kind == EventKind::abort ? Outcome::aborted : Outcome::fault));
  CHECK_FALSE(machine.result().response);
  CHECK(machine.result().again == 1);
}

TEST_CASE("an exploration that is asked for again falls silent and begins anew", "[trial][again]") {
  auto plan = exploration();
  plan.again = 1;
  plan.response_zero = ResponseZero::first_contact;
  auto machine = exploring(plan);
  machine.handle({800 * ms, EventKind::contact, 1});
  machine.handle({1500 * ms, EventKind::contact, 0});
  const auto asked = machine.handle({2000 * ms, EventKind::again, 0});
  CHECK(has(asked, ActionKind::silence, 0));
  CHECK(enters(asked, Phase::cue));
  CHECK_FALSE(has(asked, ActionKind::present, present));
  CHECK_FALSE(machine.result().zero_ns);
  CHECK(has(machine.handle({2060 * ms, EventKind::heard, 0}), ActionKind::present, present));
  machine.handle({3000 * ms, EventKind::onset, 0});
  machine.handle({3400 * ms, EventKind::contact, 1});
  CHECK(machine.result().zero_ns == 3400 * ms);
  machine.handle({4400 * ms, EventKind::answer, 1});
  CHECK(machine.result().response_time_ns == 1000 * ms);
  CHECK_FALSE(machine.result().movement_time_ns);  // the finger was lifted only in the first presentation
}

// Tests that random events never break the rules that hold for every trial.
#include <random>

#include "station/core/limits.hpp"
#include "tests/support/catch.hpp"
#include "tests/trial/timings.hpp"

using namespace trial_test;

namespace {

/// Simulates a drive that replies to `present` with onsets, and sometimes with `heard` events.
struct Drive {
  Machine& machine;
  const Timing& plan;
  std::vector<Action> follow(const std::vector<Action>& actions, std::int64_t now, std::int64_t later) {
    std::vector<Action> more;
    for (const auto& action : actions) {
      silenced |= action.kind == ActionKind::silence;
      if (action.kind != ActionKind::present) continue;
      ++presented;
      auto at = std::max(now, action.time_ns) + later;
      for (std::size_t i = 0; i < plan.intervals.size(); ++i) {
        at += plan.intervals[i].silence_ns;
        const auto next = machine.handle({at, EventKind::onset, static_cast<int>(i)});
        more.insert(more.end(), next.begin(), next.end());
        at += plan.intervals[i].duration_ns;
      }
    }
    return more;
  }
  int presented = 0;
  bool silenced = false;
};

/// Checks the rules for every finished trial, whatever happened in it. Returns the rule that is broken; "" if
/// none is.
std::string broken_invariant(const Machine& machine, const Timing& plan, const Drive& drive, bool hurt) {
  const auto& result = machine.result();
  if (!machine.done()) return "a trial that does not end";
  const bool answered = result.outcome == Outcome::answered;
  if (answered != result.response.has_value()) return "response without answered";
  if (answered != result.response_time_ns.has_value()) return "time without answer";
  if (result.correct && !answered) return "a score without an answer";
  if (answered &&
      (*result.response_time_ns < plan.anticipation_ns || *result.response_time_ns > plan.deadline_ns))
    return "response time outside anticipation and deadline";
  if (result.confidence.has_value() != (answered && plan.confidence > 0))
    return "answer or confidence missing";
  if (result.confidence.has_value() != result.confidence_time_ns.has_value())
    return "time without a confidence";
  if (result.confidence && *result.confidence_time_ns < turnpoint::core::kConfidenceGuard_ns)
    return "a press within the guard time is the confidence";
  if (drive.presented > 1 + result.again) return "presented more often than asked for";
  if (answered && drive.presented != 1 + result.again) return "answered before the last presentation";
  if (result.again > plan.again) return "presented more often than allowed";
  if (hurt && result.outcome != Outcome::fault && result.outcome != Outcome::aborted)
    return "lost frames without a void trial";
  return "";
}

}  // namespace

TEST_CASE("whatever comes in whatever order, the invariants of a trial hold", "[trial]") {
  std::mt19937_64 random(20261121);
  const auto below = [&](std::uint64_t n) { return static_cast<std::int64_t>(random() % n); };
  constexpr EventKind common[] = {EventKind::tick,    EventKind::answer, EventKind::touch,
                                  EventKind::contact, EventKind::again,  EventKind::heard};
  constexpr EventKind rare[] = {EventKind::xrun, EventKind::fault, EventKind::abort};
  for (int sequence = 0; sequence < 100'000; ++sequence) {
    auto plan = below(2) ? exploration() : two_intervals();
    if (plan.answer_ends_stimulus && below(3) == 0) {
      plan.intervals[0].scene_starts_ns = {1000 * ms};
      plan.response_zero = ResponseZero::change;
    } else if (below(4) == 0) {
      plan.response_zero = below(2) ? ResponseZero::first_contact : ResponseZero::lift_off;
    }
    if (below(2)) plan.confidence = 3;
    if (below(2)) plan.again = static_cast<int>(1 + below(2));
    Machine machine(plan);
    Drive drive{machine, plan};
    std::int64_t now = 0;
    bool hurt = false;
    drive.follow(machine.start(now), now, below(40) * ms);
    for (int event = 0; event < 60 && !machine.done(); ++event) {
      now += below(5) == 0 ? below(4000) * ms : below(50) * ms;
      const auto kind = below(60) == 0 ? rare[below(3)] : common[below(plan.again > 0 ? 6 : 4)];
      int value = static_cast<int>(below(4)) - 1;
      if (kind == EventKind::heard) {
        // an interval is heard after it has been presented
        if (machine.phase() != Phase::response) continue;
        for (value = 0; value + 1 < static_cast<int>(plan.intervals.size()); ++value)
          drive.follow(machine.handle({now, kind, value}), now, below(40) * ms);
      }
      // what was due before is decided before
      drive.follow(machine.handle({now, EventKind::tick, 0}), now, below(40) * ms);
      hurt |= kind == EventKind::xrun && value != 0 && !machine.decided();
      // the time stamp of an answer may arrive late, after that of a later one
      const auto stamped = kind == EventKind::answer && below(3) == 0 ? now - below(500) * ms : now;
      drive.follow(machine.handle({stamped, kind, value}), now, below(40) * ms);
    }
    if (machine.phase() == Phase::confidence) {
      now += turnpoint::core::kConfidenceGuard_ns;
      drive.follow(machine.handle({now, EventKind::answer, 0}), now, 0);
    }
    for (int tick = 0; tick < 40 && !machine.done(); ++tick) {
      for (int i = 0; i < static_cast<int>(plan.intervals.size()) && !machine.done(); ++i)
        drive.follow(machine.handle({now, EventKind::heard, i}), now, 0);
      now = std::max(now, machine.wake_ns().value_or(now));
      drive.follow(machine.handle({now, EventKind::tick, 0}), now, 0);
    }
    if (const auto broken = broken_invariant(machine, plan, drive, hurt); !broken.empty())
      FAIL(broken << ", sequence " << sequence << " " << name(machine.result().outcome));
  }
  SUCCEED();
}

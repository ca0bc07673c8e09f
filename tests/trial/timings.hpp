#pragma once
#include <cstdint>
// Trial timings, and trial machines that were run up to a certain phase. The tests of the trial machine share
// them.
#include "station/trial/machine.hpp"

namespace trial_test {

using namespace turnpoint::trial;

inline constexpr std::int64_t ms = 1'000'000;

inline Timing exploration() {
  Timing plan;
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

inline Timing two_intervals() {
  Timing plan;
  plan.intervals = {{1500 * ms, {}}, {1500 * ms, {}, 1000 * ms}};
  plan.response_zero = ResponseZero::interval_off;
  plan.deadline_ns = 3000 * ms;
  plan.iti_ns = 800 * ms;
  plan.correct = 0;
  return plan;
}

inline bool has(const std::vector<Action>& actions, ActionKind kind, int value) {
  for (const auto& action : actions)
    if (action.kind == kind && action.value == value) return true;
  return false;
}
inline bool enters(const std::vector<Action>& actions, Phase phase) {
  return has(actions, ActionKind::enter, static_cast<int>(phase));
}

/// Starts at time 0 and advances the machine to the first frame of the exploration at 500 ms.
inline Machine exploring(const Timing& plan = exploration()) {
  Machine machine(plan);
  machine.start(0);
  machine.handle({500 * ms, EventKind::onset, 0});
  machine.handle({500 * ms, EventKind::tick, 0});
  return machine;
}

/// Presents two intervals from 10 ms on, and gives the first choice 300 ms after the end of the second.
inline Machine answered_after_two() {
  Machine machine(two_intervals());
  machine.start(0);
  machine.handle({10 * ms, EventKind::onset, 0});
  machine.handle({2510 * ms, EventKind::onset, 1});
  machine.handle({1520 * ms, EventKind::heard, 0});
  machine.handle({4310 * ms, EventKind::answer, 0});
  return machine;
}

}  // namespace trial_test

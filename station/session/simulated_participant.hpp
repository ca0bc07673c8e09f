#pragma once
#include <cstdint>
#include <deque>
#include <optional>

#include "station/session/inputs.hpp"
#include "station/simulation/observer.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::session {

/// What a simulated participant will do next, in the order of time stamps. The session tells it what is
/// asked, and the virtual stage takes its inputs when their time has come. Each call of answer(), set() and
/// will() replaces what the participant was about to do. What would lie before `now_ns` happens then.
class SimulatedParticipant {
 public:
  explicit SimulatedParticipant(simulation::Respondent observer);

  /// Answers this question, or asks for the intervals again, if they have been presented again fewer times
  /// than the observer wants; the finger touches and leaves the surface if the protocol asks for it. Throws
  /// core::ProgramFailed if the observer is a program that fails.
  void answer(const simulation::Question& question, const trial::SimulatedTimes& times, std::int64_t now_ns,
              int presented_again);

  /// Sets the slider of this trial and presses Done, or asks for the intervals again before. Throws like
  /// answer().
  void set(const simulation::Adjustment& adjustment, const trial::TrialSpec& spec,
           const trial::SimulatedTimes& times, std::int64_t now_ns, int presented_again);

  /// Gives this input at the time input.time_ns.
  void will(Input input, std::int64_t now_ns);

  void forget() { next_.clear(); }
  /// The time of the next input; empty if nothing is planned.
  std::optional<std::int64_t> next_ns() const;
  /// Takes the next input. There must be one.
  Input take();

 private:
  simulation::Respondent observer_;
  std::deque<Input> next_;
};

}  // namespace turnpoint::session

#pragma once
#include <cstdint>
#include <vector>

#include "station/core/problem.hpp"
#include "station/protocol/protocol.hpp"
#include "station/simulation/observer.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::trial {

/// Returns the question that a simulated observer answers after the last interval of a trial.
simulation::Question question_of(const TrialSpec& spec, const protocol::Protocol& protocol,
                                 std::uint64_t seed);

/// Returns the setting of the slider at which the scenes of the interval are equal. If there is one scene
/// only, or if they are never equal: 0 or, if the slider does not reach that, the middle of its range.
double equal_setting(const protocol::Protocol& protocol, const protocol::Factors& factors);

/// Returns the slider that a simulated observer has to set in a trial.
simulation::Adjustment adjustment_of(const TrialSpec& spec, const protocol::Protocol& protocol,
                                     std::uint64_t seed);

/// Says where the times of the protocol do not suit this simulated observer, so that its trials are late,
/// early or guesses: each deadline that leaves it less than kLeastDecision_s, and answers that come before
/// `anticipation_s`. A slider is set in the time that there is. These are facts about the observer and not
/// about people or the protocol.
std::vector<core::Problem> observer_notes(const protocol::Protocol& protocol,
                                          const simulation::Observer& observer);

/// The least time for which a simulated observer's decision is more than a guess, in s.
inline constexpr double kLeastDecision_s = 0.1;

}  // namespace turnpoint::trial

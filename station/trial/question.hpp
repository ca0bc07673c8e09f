#pragma once
#include <cstdint>

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

}  // namespace turnpoint::trial

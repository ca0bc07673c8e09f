#pragma once
#include <cstdint>

#include "station/observer/observer.hpp"
#include "station/protocol/protocol.hpp"
#include "station/trial/director.hpp"

namespace turnpoint::trial {

/// The question that the trial's last interval asks a simulated observer.
observer::Question question_of(const TrialSpec& spec, const protocol::Protocol& protocol, std::uint64_t seed);

/// The slider that a simulated observer has to set.
observer::Adjustment adjustment_of(const TrialSpec& spec, std::uint64_t seed);

}  // namespace turnpoint::trial

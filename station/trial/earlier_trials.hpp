#pragma once
#include <vector>

#include "station/core/records.hpp"
#include "station/procedure/continuation.hpp"
#include "station/protocol/protocol.hpp"

namespace turnpoint::trial {

/// Adds what the procedures that continue on another day did in one session: their experimental trials in the
/// last attempt at each block.
void add_earlier_trials(const protocol::Protocol& protocol, const std::vector<core::BlockRecord>& blocks,
                        procedure::EarlierTrials& earlier);

}  // namespace turnpoint::trial

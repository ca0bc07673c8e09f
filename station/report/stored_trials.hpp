#pragma once
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/report/session_data.hpp"

namespace turnpoint::report {

/// Fills in a session's trials, of each block the last attempt, and what decides how they are analysed:
/// design, conditions, function, scale, ids of the answers, what is shown, exclusion of response times.
/// Stored and rehearsed sessions go the same way.
void add_trials(const std::vector<records::BlockRecord>& blocks, const protocol::Protocol& protocol,
                report::SessionData& data);

}  // namespace turnpoint::report

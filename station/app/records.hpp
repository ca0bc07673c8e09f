#pragma once
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/report/session_data.hpp"
#include "station/store/session_log.hpp"

namespace turnpoint::app {

/// Fills in a session's trials, of each block the last attempt, and what decides how they are analysed:
/// design, function, scale, labels in `language`, exclusion of response times. Stored and rehearsed sessions
/// go the same way.
void add_trials(const std::vector<store::BlockRecord>& blocks, const protocol::Protocol& protocol,
                const std::string& language, report::SessionData& data);

}  // namespace turnpoint::app

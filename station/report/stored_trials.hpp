#pragma once
#include <vector>

#include "station/core/records.hpp"
#include "station/protocol/protocol.hpp"
#include "station/report/session_data.hpp"

namespace turnpoint::report {

/// The models by which the report computes d' in this kind of task; empty if it computes none.
std::vector<analysis::Deciding> deciding_in(protocol::TaskKind kind);

/// Fills in a session's trials, from the last attempt at each block, with what force cells measured. Also
/// fills in the settings that determine their analysis: design, conditions, function, scale, ids of the
/// answers, the parts of the report, and the rule that excludes response times. Used for both stored and
/// simulated sessions. Of a file with several tasks, `protocol` is as one of them sees it, and `blocks` has
/// its trials only (of_task()).
void add_trials(const std::vector<core::BlockRecord>& blocks, const protocol::Protocol& protocol,
                SessionData& data);

/// The blocks with the trials of one of the protocol's tasks only.
std::vector<core::BlockRecord> of_task(std::vector<core::BlockRecord> blocks,
                                       const protocol::Protocol& protocol, std::size_t task);

/// Fills in the trials of all other tasks, which rules of exclusion count as well. `blocks` has all trials.
void add_other_trials(const std::vector<core::BlockRecord>& blocks, const protocol::Protocol& protocol,
                      std::size_t task, SessionData& data);

/// Returns the last attempt at each block. The trials of earlier attempts are not analysed.
std::vector<const core::BlockRecord*> last_attempts(const std::vector<core::BlockRecord>& blocks);

}  // namespace turnpoint::report

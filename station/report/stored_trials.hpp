#pragma once
#include <map>
#include <string>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/report/session_data.hpp"

namespace turnpoint::report {

/// The models by which the report computes d' in this kind of task; empty if it computes none.
std::vector<analysis::Deciding> deciding_in(protocol::TaskKind kind);

/// Fills in a session's trials, from the last attempt at each block, with what force cells measured. Also
/// fills in the settings that determine their analysis: design, conditions, function, scale, ids of the
/// answers, the parts of the report, and the rule that excludes response times. Used for both stored and
/// simulated sessions. Needs `data.seed`, the session's seed.
void add_trials(const std::vector<records::BlockRecord>& blocks, const protocol::Protocol& protocol,
                report::SessionData& data);

/// Adds the estimates that separate programs gave at the end of these blocks. Call this after add_trials().
void add_program_estimates(const std::vector<records::BlockRecord>& blocks,
                           const std::vector<records::EventRow>& events, report::SessionData& data);

/// Adds what a separate program has estimated from all trials of the session.
void add_estimator(const std::string& program, const std::map<std::string, procedure::Estimate>& estimates,
                   report::SessionData& data);

}  // namespace turnpoint::report

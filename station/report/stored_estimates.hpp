#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "station/core/records.hpp"
#include "station/procedure/continuation.hpp"
#include "station/protocol/protocol.hpp"
#include "station/report/session_data.hpp"

namespace turnpoint::report {

/// Recomputes the final estimates of adaptive procedures, and which of them ended early, from the stored
/// answers of a session, from the last attempt at each block, and adds them to `data`. `seed` is that of the
/// session, and `earlier` are the trials of the participant's earlier sessions, for procedures that continue.
void add_estimates(const std::vector<core::BlockRecord>& blocks, const protocol::Protocol& protocol,
                   std::uint64_t seed, const procedure::EarlierTrials& earlier, SessionData& data);

/// Adds the estimates that separate programs gave at the end of these blocks.
void add_program_estimates(const std::vector<core::BlockRecord>& blocks,
                           const std::vector<core::EventRow>& events, const protocol::Protocol& protocol,
                           SessionData& data);

/// Adds what a separate program has estimated from all trials of the session.
void add_estimator(const std::string& program, const std::map<std::string, procedure::Estimate>& estimates,
                   const protocol::Protocol& protocol, SessionData& data);

/// An axis label: "Contrast (dB)" for the name "contrast" and the unit "dB".
core::Phrase axis_label(std::string name, const std::string& unit);

/// Unit of a procedure's parameter, made from the units of its level and of its second dimension: "dB/mm" for
/// a gradient; "" if it has none.
std::string unit_of(const std::string& parameter, const procedure::Spec& spec);

/// Leaves out the estimates of procedures that ask other tasks than this one of several. `protocol` is as the
/// task sees it.
void keep_estimates_of(const protocol::Protocol& protocol, SessionData& data);

}  // namespace turnpoint::report

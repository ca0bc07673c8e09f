#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/report/summary.hpp"
#include "station/session/along_strip.hpp"
#include "station/store/read.hpp"

namespace turnpoint::view {

/// Collects the data of one stored session for a report, for each task of its protocol. The protocol is
/// parsed from the text that is stored with the session. If a block was repeated, its last attempt counts.
/// Throws StoreError, or core::BadInput if this program can no longer read the protocol text.
std::vector<report::SessionData> report_data(const std::string& database, const std::string& session_id);

/// Adds to `data` what the procedures of a stored session, and its separate programs, estimated themselves.
void add_own_estimates(const std::string& database, const store::StoredSession& stored,
                       const protocol::Protocol& protocol, report::SessionData& data);

/// Returns the friction along the strip as curves for a report, one for each direction in which there were
/// strokes.
std::vector<analysis::FrictionCurve> curves_of(const session::AlongStrip& along);

/// Returns the protocol of the newest session with this protocol id and run mode at these stations, or at any
/// if the set is empty. Returns nothing if there is no such session.
std::optional<protocol::Protocol> newest_protocol(const std::string& database, const std::string& protocol_id,
                                                  core::RunMode mode,
                                                  const std::set<std::string>& stations = {});

/// Returns the session to report: the named one or, without a name, the newest session that matches the
/// filter and has trials. Throws StoreError (missing) if there is none.
std::string session_to_report(const std::string& database, const store::SessionFilter& filter);

}  // namespace turnpoint::view

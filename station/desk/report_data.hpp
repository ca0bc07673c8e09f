#pragma once
#include <string>
#include <vector>

#include "station/report/summary.hpp"
#include "station/store/read.hpp"

namespace turnpoint::desk {

/// The data of one stored session for a report. The protocol is parsed from the text stored with the session,
/// rows become trial records, and events become words. Of blocks that were repeated, the last attempt counts.
/// Throws StoreError, or text::BadInput if the protocol text can no longer be read.
report::SessionData report_data(const std::string& database, const std::string& session_id);

/// The session to report: the named one, else the newest that matches the filter and has trials. Throws
/// StoreError (missing) if there is none.
std::string session_to_report(const std::string& database, const store::SessionFilter& filter);

}  // namespace turnpoint::desk

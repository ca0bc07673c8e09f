#pragma once
#include <string>
#include <vector>

#include "station/report/summary.hpp"
#include "station/store/read.hpp"

namespace turnpoint::desk {

/// One stored session as a report wants it: the protocol is read from the text stored with the session, rows
/// become trial records, what the station went through becomes words. Blocks that were begun again count by
/// their last attempt. Throws StoreError, text::BadInput for a protocol text that no longer reads.
report::SessionData report_data(const std::string& database, const std::string& session_id);

/// The session to report: the one named, else the newest of the filter that has trials. Throws StoreError
/// (missing) where there is none.
std::string session_to_report(const std::string& database, const store::SessionFilter& filter);

}  // namespace turnpoint::desk

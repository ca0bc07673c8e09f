#pragma once
#include <string>

#include "station/store/error.hpp"

namespace turnpoint::store {

/// Adds a researcher's note to a session that is not running; the rows of its trials do not change. Throws
/// StoreError, or terms::UsageError for an empty note.
void annotate(const std::string& database, const std::string& session_id, const std::string& text);

/// Closes an interrupted session that nobody will continue (status abandoned) and stores the reason. Throws
/// StoreError (refused) if the session is not interrupted.
void abandon(const std::string& database, const std::string& session_id, const std::string& reason);

}  // namespace turnpoint::store

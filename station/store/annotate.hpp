#pragma once
#include <string>

#include "station/store/error.hpp"

namespace turnpoint::store {

/// Adds a researcher's note to a session that is not running; rows of trials stay as they are. Throws
/// StoreError, terms::UsageError for an empty note.
void annotate(const std::string& database, const std::string& session_id, const std::string& text);

/// Closes an interrupted session that nobody shall go on with (status abandoned), with the reason. Throws
/// StoreError: refused where it is not interrupted.
void abandon(const std::string& database, const std::string& session_id, const std::string& reason);

}  // namespace turnpoint::store

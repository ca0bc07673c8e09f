#pragma once
#include <string>

#include "station/store/error.hpp"

namespace turnpoint::store {

/// Adds a researcher's note to a session that is not running. The rows of its trials do not change. Throws
/// StoreError, or terms::UsageError for an empty note.
void annotate(const std::string& database, const std::string& session_id, const std::string& text);

/// Marks an interrupted session as abandoned, because nobody will continue it, and stores the reason. Throws
/// StoreError (refused) if the session is not interrupted.
void abandon(const std::string& database, const std::string& session_id, const std::string& reason);

}  // namespace turnpoint::store

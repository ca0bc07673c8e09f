#pragma once
#include <string>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// SHA-256 over every row of a session but its status, in the order of their keys: equal in two databases
/// exactly where they hold the same session. `schema` is "main" or the name of an attached database.
std::string session_checksum(Database& database, const std::string& schema, const std::string& session_id);

}  // namespace turnpoint::store

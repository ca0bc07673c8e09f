#pragma once
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// Each step migrates the schema from version i to i + 1. A new database runs all steps too, so that it
/// cannot differ from a migrated one. Never edit a step that was released.
const std::vector<std::string>& schema_steps();

/// The schema version that this program writes: PRAGMA user_version.
int schema_version();

/// PRAGMA application_id: "TPNT".
constexpr int kApplicationId = 0x54504e54;

/// Creates the schema of `version` (default: the current one) in an empty database. For new files, and for
/// tests of old ones.
void create_schema(Database& database, int version);

/// Migrates an older database to the current version in one transaction. Throws StoreError for a newer one,
/// and for a file that is not Turnpoint's.
void migrate(Database& database);

/// Returns the schema version. Throws StoreError if the file is not Turnpoint's or newer than this program.
int checked_version(Database& database);

}  // namespace turnpoint::store

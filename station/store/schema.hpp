#pragma once
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// One step from schema version i to i + 1; the whole schema is all steps in order, so that a new database
/// and a migrated one cannot differ. A step that was released is never edited.
const std::vector<std::string>& schema_steps();

/// The version that this program writes: PRAGMA user_version.
int schema_version();

/// PRAGMA application_id: "TPNT".
constexpr int kApplicationId = 0x54504e54;

/// Takes an empty database to `version` (all steps by default). For new files and for tests of old ones.
void create_schema(Database& database, int version);

/// Takes an older database to the current version in one transaction. Throws StoreError for a newer one, and
/// for a file that is not Turnpoint's.
void migrate(Database& database);

/// Throws StoreError unless the file is Turnpoint's and no newer than this program; returns its version.
int checked_version(Database& database);

}  // namespace turnpoint::store

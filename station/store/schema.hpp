#pragma once
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// SQL statements; step i migrates the schema from version i to i + 1. A new database runs all steps too, so
/// that it cannot differ from a migrated one. Never edit a step that was released.
const std::vector<std::string>& schema_steps();

/// The first of these steps.
const char* schema_version_1();

/// The schema version that this program writes. Databases have it as PRAGMA user_version.
int schema_version();

/// Identifies the files of the program as PRAGMA application_id: "TPNT".
constexpr int kApplicationId = 0x54504e54;

/// Creates the schema of this version in an empty database. Used for new files, and with old versions in
/// tests.
void create_schema(Database& database, int version);

/// Migrates an older database to the current version, in one transaction. Throws StoreError for a database of
/// a newer release, and for a file that is not Turnpoint's.
void migrate(Database& database);

/// Returns the schema version of a database. Throws StoreError if the file is not Turnpoint's, or if a newer
/// release wrote it.
int checked_version(Database& database);

}  // namespace turnpoint::store

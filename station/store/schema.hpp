#pragma once
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// The number of the schema, which databases have as PRAGMA user_version. It changes with the tables, the
/// columns, and the bytes that the checksums cover. The program reads no other schema.
constexpr int kSchema = 13;

/// The commit whose `turnpoint export` reads the schemas before the present one.
constexpr const char* kLastReader = "fb95ea6f";

/// Identifies the files of the program as PRAGMA application_id: "TPNT".
constexpr int kApplicationId = 0x54504e54;

/// Creates all tables, indexes and triggers in an empty database.
void create_schema(Database& database);

/// Throws StoreError if the file is not Turnpoint's, if it has another schema, or if one of its tables is not
/// as create_schema() makes it. Read nothing else before: a view in place of a table could keep its reader
/// busy for ever.
void require_schema(Database& database);

/// Throws StoreError if the database has a trigger that create_schema() does not make.
void require_no_trigger(Database& database);

/// Compares all tables, columns, indexes, triggers and views with those that create_schema() makes. Returns
/// one sentence for each difference.
std::vector<std::string> schema_problems(Database& database);

}  // namespace turnpoint::store

#include "station/store/fields.hpp"

#include <map>

#include "station/store/schema.hpp"
#include "tests/store/sample.hpp"
#include "tests/support/catch.hpp"

using namespace turnpoint::store;

namespace {

struct Kept {
  std::string type;
  bool nullable = false;
};

/// Returns the columns of a table according to the schema of the database.
std::map<std::string, Kept> columns_in_schema(Database& database, const std::string& table) {
  std::map<std::string, Kept> columns;
  Statement rows(database, "SELECT name, type, \"notnull\", pk FROM pragma_table_info(?)");
  rows.bind(table);
  while (rows.step()) columns[rows.text(0)] = {rows.text(1), rows.integer(2) == 0 && rows.integer(3) == 0};
  return columns;
}

/// Returns the differences between the fields of a record and the schema, one per line.
template <class Record>
std::string differences(Database& database, const Table<Record>& table) {
  std::string found;
  auto columns = columns_in_schema(database, table.name);
  for (const auto* name : table.place)
    if (columns.erase(name) == 0) found += std::string(name) + " is not in the schema\n";
  for (const auto& field : table.fields) {
    const auto column = columns.find(field.name);
    if (column == columns.end()) {
      found += std::string(field.name) + " is not in the schema\n";
      continue;
    }
    if (column->second.type != field.type || column->second.nullable != field.nullable)
      found += std::string(field.name) + " is " + column->second.type +
               (column->second.nullable ? " or NULL" : "") + " in the schema\n";
    columns.erase(column);
  }
  for (const auto& [name, kept] : columns) found += name + " is only in the schema\n";
  return found;
}

}  // namespace

TEST_CASE("the records' tables of fields contain each column of the schema with its type", "[store]") {
  Database database(":memory:", Database::Access::create);
  create_schema(database);
  CHECK(differences(database, segment_table()).empty());
  CHECK(differences(database, block_table()).empty());
  CHECK(differences(database, trial_table()) == "trial_id is only in the schema\n");
  CHECK(differences(database, tone_table()).empty());
  CHECK(differences(database, signal_table()).empty());
  CHECK(differences(database, event_table()).empty());
  CHECK(differences(database, check_table()).empty());
  CHECK(differences(database, answer_table()).empty());
  CHECK(differences(database, friction_level_table()).empty());
  CHECK(differences(database, program_table()).empty());
  CHECK(differences(database, estimate_table()).empty());
  CHECK(differences(database, session_table()).empty());
  CHECK(differences(database, protocol_table()).empty());
  CHECK(differences(database, rig_table()).empty());
  CHECK(differences(database, calibration_table()).empty());

  auto wrong = event_table();
  wrong.fields[0].name = "segmentindex";
  wrong.fields[1].type = "REAL";
  CHECK(differences(database, wrong) ==
        "segmentindex is not in the schema\ntime_ns is INTEGER in the schema\nsegment_index is only in the "
        "schema\n");
}

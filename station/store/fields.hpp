#pragma once
#include <bit>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "station/store/names.hpp"
#include "station/store/session_log.hpp"
#include "station/store/sqlite.hpp"
#include "station/store/text_table.hpp"

namespace turnpoint::store {

/// One column of a database table: where its value is in the C++ struct, its name in the exports, and its
/// meaning. All code that handles records uses these descriptions: writing, reading, exports, codebook and
/// checksum. Only the SQL that creates the tables is separate (schema.cpp). A test compares that SQL with
/// these descriptions.
template <class Record>
struct Field {
  const char* name;
  const char* csv;          ///< column in the exports; "" if the column is not exported
  const char* description;  ///< text for the codebook
  const char* unit;         ///< "" if the column has no unit
  const char* values;       ///< the words that may occur; "" if there is no fixed list
  const char* type;         ///< type of the column in SQLite: INTEGER, REAL, TEXT or BLOB
  bool nullable;
  void (*bind)(Statement&, int index, const Record&);
  void (*read)(const Statement&, int column, Record&);
  Cell (*cell)(const Record&);
};

/// A table of the database. Its first columns (`place`) contain the keys, and other values that are known to
/// the session log but not stored in a Record. The columns for the members of Record (`fields`) follow.
template <class Record>
struct Table {
  const char* name;
  std::vector<const char*> place;
  std::vector<Field<Record>> fields;
};

const Table<SegmentStart>& segment_table();
const Table<BlockStart>& block_table();
const Table<TrialRow>& trial_table();
const Table<ToneRow>& tone_table();
const Table<SignalRow>& signal_table();
const Table<EventRow>& event_table();
const Table<CheckRow>& check_table();
const Table<AnswerRow>& answer_table();
const Table<FrictionLevelRow>& friction_level_table();
const Table<ProgramRow>& program_table();
const Table<EstimateRow>& estimate_table();

/// The columns of a session. Its data are in four tables, because many sessions share a protocol, a rig and a
/// calibration. Status and reason are the last columns, and the only ones that ever change.
const Table<SessionRecord>& session_table();
const Table<SessionRecord>& protocol_table();
const Table<SessionRecord>& rig_table();
const Table<SessionRecord>& calibration_table();

/// Returns the names of all columns as "a, b, c", with `prefix` before each name. The key columns (`place`)
/// come first.
template <class Record>
std::string column_list(const Table<Record>& table, const std::string& prefix = "") {
  std::string list;
  const auto add = [&](const char* name) { list += (list.empty() ? "" : ", ") + prefix + name; };
  for (const auto* name : table.place) add(name);
  for (const auto& field : table.fields) add(field.name);
  return list;
}

template <class Record>
std::string insert_sql(const Table<Record>& table) {
  std::string marks = "?";
  for (std::size_t i = 1; i < table.place.size() + table.fields.size(); ++i) marks += ",?";
  return std::string("INSERT INTO ") + table.name + " (" + column_list(table) + ") VALUES (" + marks + ")";
}

/// Binds all values of a row: those of the `place` columns, then those of the record. Returns the statement,
/// ready to run.
template <class Record, class... Place>
Statement& bind_row(Statement& statement, const Table<Record>& table, const Record& record,
                    const Place&... place) {
  int index = 0;
  statement.reset();
  (statement.bind_value(++index, place), ...);
  for (const auto& field : table.fields) field.bind(statement, ++index, record);
  return statement;
}

/// Reads the fields of a record from consecutive columns. The first one is `column`.
template <class Record>
void read_fields(const Statement& row, const Table<Record>& table, int column, Record& record) {
  for (const auto& field : table.fields) field.read(row, column++, record);
}

/// Reads a record from a row whose columns are those of column_list().
template <class Record>
Record record_of(const Statement& row, const Table<Record>& table) {
  Record record;
  read_fields(row, table, static_cast<int>(table.place.size()), record);
  return record;
}

/// Convert factor values to the JSON object of the `factors` column and back, a list of names to a JSON list
/// and back, and the channels of a signal to a list of objects and back.
std::string to_json(const std::map<std::string, FactorValue>& factors);
std::string to_json(const std::vector<std::string>& list);
std::string to_json(const std::vector<SignalChannel>& channels);
void from_json(const std::string& text, std::map<std::string, FactorValue>& factors);
void from_json(const std::string& text, std::vector<std::string>& list);
void from_json(const std::string& text, std::vector<SignalChannel>& channels);

}  // namespace turnpoint::store

#include "station/collector/tables.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "station/store/fields.hpp"
#include "station/store/schema.hpp"

namespace turnpoint::collector {

namespace {

using store::Database;
using store::Statement;

/// The rowid of a trial, which numbers the rows of one file. It is not collected, because it means nothing in
/// another database.
constexpr const char* kRowNumber = "trial_id";

void read_columns(Database& database, CollectedTable& table) {
  Statement rows(database,
                 "SELECT name, type, \"notnull\", dflt_value, pk FROM pragma_table_info(?) ORDER BY cid");
  rows.bind(table.name);
  std::map<std::int64_t, std::string> key;
  while (rows.step()) {
    if (rows.text(0) == kRowNumber) continue;
    const bool in_key = rows.integer(4) != 0;
    table.columns.push_back(
        {rows.text(0), rows.text(1), rows.integer(2) == 0 && !in_key, rows.text(3), "", "", ""});
    if (in_key) key[rows.integer(4)] = rows.text(0);
  }
  for (const auto& [place, name] : key) table.key.push_back(name);
}

void read_unique(Database& database, CollectedTable& table) {
  Statement indexes(database, "SELECT name FROM pragma_index_list(?) WHERE origin = 'u' ORDER BY seq DESC");
  indexes.bind(table.name);
  while (indexes.step()) {
    Statement columns(database, "SELECT name FROM pragma_index_info(?) ORDER BY seqno");
    columns.bind(indexes.text(0));
    std::vector<std::string> names;
    while (columns.step()) names.push_back(columns.text(0));
    if (table.key.empty())
      table.key = std::move(names);
    else
      table.unique.push_back(std::move(names));
  }
}

void read_references(Database& database, CollectedTable& table) {
  Statement rows(database,
                 "SELECT id, \"table\", \"from\", \"to\" FROM pragma_foreign_key_list(?) ORDER BY id, seq");
  rows.bind(table.name);
  std::map<std::int64_t, Reference> references;
  while (rows.step()) {
    auto& reference = references[rows.integer(0)];
    reference.table = rows.text(1);
    reference.columns.push_back(rows.text(2));
    reference.to.push_back(rows.text(3));
  }
  for (auto& [id, reference] : references)
    if (reference.table != "participant")  // is not collected
      table.references.push_back(std::move(reference));
}

/// Adds the columns' descriptions, and returns the columns that the checksum chain covers, in the order in
/// which it hashes them.
template <class Record>
std::vector<std::string> describe(CollectedTable& table, const store::Table<Record>& described) {
  std::vector<std::string> covered(described.place.begin(), described.place.end());
  for (const auto& field : described.fields) {
    covered.emplace_back(field.name);
    for (auto& column : table.columns)
      if (column.name == field.name) {
        column.description = field.description;
        column.unit = field.unit;
        column.values = field.values;
      }
  }
  return covered;
}

void describe_chain(CollectedTable& table) {
  const auto part = [&](const auto& described, const std::string& counter, const std::string& order,
                        const std::string& last) {
    table.chain = ChainPart{describe(table, described), counter, order, last};
  };
  const auto& name = table.name;
  if (name == "segment") part(store::segment_table(), "segment_index", "segment_index", "last_segment");
  if (name == "block") part(store::block_table(), "run_order", "run_order", "last_block");
  if (name == "trial") part(store::trial_table(), "trial_index", "trial_index", "last_trial");
  if (name == "tone")
    part(store::tone_table(), "trial_index", "trial_index,interval_index,scene_index,tone_index",
         "last_trial");
  if (name == "signal") part(store::signal_table(), "trial_index", "trial_index,stream", "last_trial");
  if (name == "event") part(store::event_table(), "event_index", "event_index", "last_event");
  if (name == "self_test") part(store::check_table(), "event_index", "event_index,check_index", "last_event");
  if (name == "answer") part(store::answer_table(), "event_index", "event_index,answer_index", "last_event");
  if (name == "friction_level")
    part(store::friction_level_table(), "event_index", "event_index,level_index", "last_event");
  if (name == "program")
    part(store::program_table(), "event_index", "event_index,program_index", "last_event");
  if (name == "estimate")
    part(store::estimate_table(), "event_index", "event_index,estimate_index", "last_event");
  if (name == "session") {
    table.provenance = describe(table, store::session_table());
    // the last two columns, status and reason, are part of each link instead
    table.provenance.resize(table.provenance.size() - 2);
  }
  if (name == "protocol") table.provenance = describe(table, store::protocol_table());
  if (name == "rig") table.provenance = describe(table, store::rig_table());
  if (name == "calibration") table.provenance = describe(table, store::calibration_table());
}

std::vector<CollectedTable> read_tables() {
  Database database(":memory:", Database::Access::create);
  store::create_schema(database);
  std::vector<CollectedTable> tables;
  for (const auto* name :
       {"enrolment", "protocol", "rig",    "calibration", "session",     "segment",  "block",
        "trial",     "tone",     "signal", "event",       "self_test",   "answer",   "friction_level",
        "program",   "estimate", "link",   "annotation",  "same_person", "tombstone"}) {
    CollectedTable table;
    table.name = name;
    read_columns(database, table);
    read_unique(database, table);
    read_references(database, table);
    describe_chain(table);
    // On a server, a station can make a tombstone with the id of another station's session. It must not stand
    // in the place of the other station's own.
    if (table.name == "tombstone") table.key = {"session_id", "station_id"};
    tables.push_back(std::move(table));
  }
  return tables;
}

}  // namespace

const Column& CollectedTable::column(std::string_view wanted) const {
  for (const auto& column : columns)
    if (column.name == wanted) return column;
  throw std::logic_error("table " + name + " has no column " + std::string(wanted));
}

bool CollectedTable::has(std::string_view wanted) const {
  return std::any_of(columns.begin(), columns.end(),
                     [&](const auto& column) { return column.name == wanted; });
}

const std::vector<CollectedTable>& collected_tables() {
  static const auto tables = read_tables();
  return tables;
}

const CollectedTable& collected_table(std::string_view name) {
  for (const auto& table : collected_tables())
    if (table.name == name) return table;
  throw std::logic_error("table " + std::string(name) + " is not collected");
}

std::string quoted(const std::string& name) { return '"' + name + '"'; }

std::string quoted_list(const std::vector<std::string>& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + quoted(name);
  return list;
}

std::string column_list(const CollectedTable& table) {
  std::vector<std::string> names;
  for (const auto& column : table.columns) names.push_back(column.name);
  return quoted_list(names);
}

std::string literal(const std::string& text) {
  std::string escaped = "'";
  for (const char c : text) escaped += c == '\'' ? "''" : std::string(1, c);
  return escaped + "'";
}

}  // namespace turnpoint::collector

#include "station/collector/schema.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "station/collector/tables.hpp"
#include "station/store/checksum.hpp"
#include "station/store/schema.hpp"

namespace turnpoint::collector {

namespace {

std::string type_of(const Column& column) {
  if (column.type == "INTEGER") return "bigint";
  if (column.type == "REAL") return "double precision";
  return column.type == "BLOB" ? "bytea" : "text";
}

/// Returns the words of a list such as "a | b | c". Returns nothing if the list is incomplete or contains a
/// word for "no value".
std::vector<std::string> words_of(const std::string& values) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < values.size();) {
    const auto end = std::min(values.find(" | ", at), values.size());
    words.push_back(values.substr(at, end - at));
    at = end + 3;
  }
  const bool open = std::any_of(words.begin(), words.end(),
                                [](const auto& word) { return word == "..." || word == "n/a"; });
  return open ? std::vector<std::string>{} : words;
}

std::string check_of(const Column& column) {
  std::string list;
  for (const auto& word : words_of(column.values))
    list += (list.empty() ? "" : ", ") + (column.type == "TEXT" ? literal(word) : word);
  return list.empty() ? "" : fmt::format(" CHECK ({} IN ({}))", quoted(column.name), list);
}

std::string definition(const Column& column) {
  return fmt::format("{} {}{}{}{}", quoted(column.name), type_of(column), column.nullable ? "" : " NOT NULL",
                     column.fallback.empty() ? "" : " DEFAULT " + column.fallback, check_of(column));
}

std::string create_table(const CollectedTable& table) {
  std::string lines;
  for (const auto& column : table.columns) lines += "  " + definition(column) + ",\n";
  lines += fmt::format("  PRIMARY KEY ({})", quoted_list(table.key));
  for (const auto& names : table.unique) lines += fmt::format(",\n  UNIQUE ({})", quoted_list(names));
  for (const auto& reference : table.references)
    lines += fmt::format(",\n  FOREIGN KEY ({}) REFERENCES turnpoint.{} ({}){}",
                         quoted_list(reference.columns), reference.table, quoted_list(reference.to),
                         reference.columns.front() == "session_id" ? " ON DELETE CASCADE" : "");
  return fmt::format("CREATE TABLE IF NOT EXISTS turnpoint.{} (\n{}\n);\n", table.name, lines);
}

/// Returns the SQL that adds the columns which an older version of the collector did not have.
std::string comments(const CollectedTable& table) {
  std::string sql;
  for (const auto& column : table.columns) {
    if (column.description.empty()) continue;
    const auto unit = column.unit.empty() ? "" : fmt::format(" [{}]", column.unit);
    sql += fmt::format("COMMENT ON COLUMN turnpoint.{}.{} IS {};\n", table.name, quoted(column.name),
                       literal(column.description + unit));
  }
  return sql;
}

/// Returns the SQL that turns on row security. turnpoint_reader may read the rows by a policy. All other
/// roles reach the rows only through functions, which run as turnpoint_owner. Readers do not see tombstones:
/// the codes of participants are short, so a dictionary of codes would find those behind the hashes.
std::string protection(const std::string& table) {
  const auto sql = fmt::format(
      "ALTER TABLE turnpoint.{0} ENABLE ROW LEVEL SECURITY;\n"
      "DROP POLICY IF EXISTS readers ON turnpoint.{0};\n",
      table);
  if (table == "tombstone") return sql + "REVOKE ALL ON turnpoint.tombstone FROM turnpoint_reader;\n";
  return sql + fmt::format(
                   "CREATE POLICY readers ON turnpoint.{0} FOR SELECT TO turnpoint_reader USING (true);\n"
                   "GRANT SELECT ON turnpoint.{0} TO turnpoint_reader;\n",
                   table);
}

constexpr const char* kRoles = R"sql(
DO $do$
DECLARE wanted text;
BEGIN
  FOREACH wanted IN ARRAY ARRAY['turnpoint_owner', 'turnpoint_station', 'turnpoint_reader'] LOOP
    IF NOT EXISTS (SELECT FROM pg_roles WHERE rolname = wanted) THEN
      EXECUTE format('CREATE ROLE %I NOLOGIN', wanted);
    END IF;
  END LOOP;
  -- The groups are those of the whole server, which may have several collectors. So each role of a station or
  -- reader is let into its own database, and nobody into another.
  EXECUTE format('REVOKE CONNECT ON DATABASE %I FROM PUBLIC', current_database());
  -- A station that could make temporary objects could put its own in the place of those that the functions use.
  EXECUTE format('REVOKE TEMPORARY, CREATE ON DATABASE %I FROM PUBLIC', current_database());
  EXECUTE format('GRANT TEMPORARY, CREATE ON DATABASE %I TO turnpoint_owner', current_database());
  -- Nobody waits for ever for a lock that another holds, and a connection that has begun a transaction and does
  -- nothing is ended. A role can change these for itself, so turnpoint.end_stale() ends those that did.
  EXECUTE format('ALTER DATABASE %I SET lock_timeout = %L', current_database(), '30s');
  EXECUTE format('ALTER DATABASE %I SET idle_in_transaction_session_timeout = %L', current_database(), '60s');
  -- PostgreSQL lets everybody store large objects, take advisory locks, fill the queue of notifications and run
  -- programs in DO. The collector uses none of these.
  FOR wanted IN SELECT p.oid::regprocedure FROM pg_proc p WHERE p.pronamespace = 'pg_catalog'::regnamespace
      AND (p.proname ~ '^(lo_|pg_(try_)?advisory_)' OR p.proname IN ('loread', 'lowrite', 'pg_notify')) LOOP
    EXECUTE 'REVOKE EXECUTE ON FUNCTION ' || wanted || ' FROM PUBLIC';
  END LOOP;
  REVOKE USAGE ON LANGUAGE plpgsql FROM PUBLIC;
  GRANT USAGE ON LANGUAGE plpgsql TO turnpoint_owner;
END $do$;
GRANT pg_signal_backend, pg_read_all_stats TO turnpoint_owner;  -- for turnpoint.end_stale()
REVOKE ALL ON SCHEMA public FROM PUBLIC;
CREATE SCHEMA IF NOT EXISTS turnpoint AUTHORIZATION turnpoint_owner;
SET LOCAL ROLE turnpoint_owner;
GRANT USAGE ON SCHEMA turnpoint TO turnpoint_station, turnpoint_reader;
)sql";

constexpr const char* kOwnTables = R"sql(
CREATE TABLE IF NOT EXISTS turnpoint.version (
  only_row boolean PRIMARY KEY DEFAULT true CHECK (only_row),
  schema bigint NOT NULL
);
CREATE TABLE IF NOT EXISTS turnpoint.station (
  station_id text PRIMARY KEY CHECK (station_id <> ''),
  role name NOT NULL,
  last_contact timestamptz
);
COMMENT ON TABLE turnpoint.station IS 'Which role may store the sessions of which station';
CREATE TABLE IF NOT EXISTS turnpoint.lease (
  protocol_id text NOT NULL,
  sequence_index bigint NOT NULL CHECK (sequence_index >= 0),
  station_id text NOT NULL,
  PRIMARY KEY (protocol_id, sequence_index)
);
COMMENT ON TABLE turnpoint.lease IS 'Places in the counterbalancing of a protocol, and the stations that may use them';
)sql";

}  // namespace

std::string schema_sql() {
  std::string sql = fmt::format(
      "-- Collector of Turnpoint, schema {}, written by `turnpoint collector-schema`.\n"
      "\\set ON_ERROR_STOP on\nSET client_min_messages = warning;\n"
      "SET lock_timeout = '60s';\nBEGIN;\n{}",
      store::kSchema, kRoles);
  sql += kOwnTables;
  sql += fmt::format(
      "DO $do$ BEGIN IF (SELECT schema FROM turnpoint.version) <> {0} THEN\n"
      "  RAISE EXCEPTION 'this database has schema %, and this program writes only schema {0}; `turnpoint "
      "export` of commit {1} reads a lower one; create a new collector, or update Turnpoint here',\n"
      "    (SELECT schema FROM turnpoint.version);\nEND IF; END $do$;\n",
      store::kSchema, store::kLastReader);
  for (const auto& table : collected_tables())
    sql += create_table(table) + comments(table) + protection(table.name);
  for (const auto* own : {"version", "station", "lease"}) sql += protection(own);
  sql += fmt::format("INSERT INTO turnpoint.version (schema) VALUES ({}) ON CONFLICT DO NOTHING;\n",
                     store::kSchema);
  return sql + checksum_sql() + functions_sql() + views_sql() + "COMMIT;\n";
}

}  // namespace turnpoint::collector

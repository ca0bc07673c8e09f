#include "station/collector/fetch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

#include "station/collector/postgres.hpp"
#include "station/collector/row_stream.hpp"
#include "station/collector/tables.hpp"
#include "station/store/checksum.hpp"
#include "station/store/open.hpp"
#include "station/store/schema.hpp"

namespace turnpoint::collector {

namespace {

namespace fs = std::filesystem;

std::string make_folder() {
  auto name = (fs::temp_directory_path() / "turnpoint-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw std::system_error(errno, std::generic_category(), "making the temporary folder " + name);
  return name;
}

void require_version(Connection& server) {
  const auto rows = server.query("SELECT schema FROM turnpoint.version");
  const auto schema = rows.count() > 0 ? rows.integer(0, 0) : 0;
  if (schema == store::kSchema) return;
  throw ServerError(
      fmt::format(
          "collector: the server has schema {}, but this program reads schema {}; {}", schema, store::kSchema,
          schema < store::kSchema ? "update the server: deploy/collector upgrade" : "update Turnpoint here"),
      "");
}

/// True for tables whose rows belong to one session.
bool is_part_of_session(const CollectedTable& table) {
  return table.name != "session" && table.has("session_id");
}

/// Orders trials by the age of their session. A reader takes the session of the last row as the newest one,
/// so the session with the newest trial is copied last.
std::string order_of(const CollectedTable& table) {
  if (table.name != "trial") return "ORDER BY " + quoted_list(table.key);
  return "ORDER BY newest, session_id, trial_index";
}

/// Returns the COPY statement that reads a table. `sessions` is the WHERE condition that selects sessions; ""
/// for all.
std::string select(const CollectedTable& table, const std::string& sessions) {
  std::string sql = fmt::format("SELECT {} FROM turnpoint.{}", column_list(table), table.name);
  if (table.name == "trial")
    sql += fmt::format(
        " JOIN (SELECT session_id, max(recorded_realtime_ns) AS newest FROM turnpoint.trial {} GROUP BY"
        " session_id) x USING (session_id)",
        sessions);
  return fmt::format("COPY ({} {} {}) TO STDOUT (FORMAT binary)", sql, sessions, order_of(table));
}

std::string condition(const std::vector<store::SessionRecord>& sessions) {
  std::string list;
  for (const auto& session : sessions) list += (list.empty() ? "" : ",") + literal(session.session_id);
  return list.empty() ? "WHERE false" : "WHERE session_id IN (" + list + ")";
}

void refuse_changed(store::Database& database, const std::string& session_id) {
  const auto session = store::verify_session(database, session_id);
  if (!session.problems.empty())
    throw store::StoreError(
        store::ErrorKind::corrupt,
        fmt::format("collector: session {} of {}: {}; the rows were changed on the server",
                    session.session_id, session.participant, session.problems.front()));
}

}  // namespace

bool is_server(const std::string& database) {
  return database.starts_with("postgresql://") || database.starts_with("postgres://");
}

ReadableDatabase::ReadableDatabase(const std::string& database, const store::SessionFilter& filter)
    : path_(database) {
  if (!is_server(database)) return;
  folder_ = make_folder();
  path_ = folder_ + "/collected.sqlite";
  try {
    fetch(database, filter);
  } catch (...) {
    discard();
    throw;
  }
}

ReadableDatabase::~ReadableDatabase() { discard(); }

void ReadableDatabase::discard() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

void ReadableDatabase::fetch(const std::string& address, const store::SessionFilter& filter) {
  Connection server(address);
  require_version(server);
  auto writer = store::open_writer(path_, store::IfMissing::create);
  auto& database = writer.database;
  database.execute("PRAGMA synchronous = OFF");
  const ServerTransaction snapshot(server, "ISOLATION LEVEL REPEATABLE READ READ ONLY");
  store::Transaction transaction(database);
  database.execute("PRAGMA defer_foreign_keys = ON");  // the codes come last
  const auto copy = [&](const CollectedTable& table, const std::string& sessions) {
    receive_rows(server, select(table, sessions), table, database);
  };
  for (const auto& table : collected_tables())
    if (!is_part_of_session(table)) copy(table, "");
  database.execute(
      "INSERT INTO participant SELECT participant FROM session UNION SELECT participant FROM enrolment");
  const bool all = filter.session_id.empty() && filter.participant.empty() && filter.protocol_id.empty();
  const auto chosen = store::list_sessions(database, filter);
  for (const auto& table : collected_tables())
    if (is_part_of_session(table) && table.name != "tombstone")  // readers may not read tombstones
      copy(table, all ? "" : condition(chosen));
  transaction.commit();
  for (const auto& session : chosen) refuse_changed(database, session.session_id);
}

}  // namespace turnpoint::collector

#include "station/collector/fetch.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

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
  if (schema == store::schema_version()) return;
  throw ServerError(
      fmt::format("collector: the server has schema {}, but this program reads schema {}; {}", schema,
                  store::schema_version(),
                  schema < store::schema_version() ? "update the server: deploy/collector upgrade"
                                                   : "update Turnpoint here"),
      "");
}

/// Orders trials by the age of their session. In a station's file, readers find the newest session by the row
/// of its newest trial. So the session whose last trial is the newest is copied last.
std::string order_of(const CollectedTable& table) {
  if (table.name != "trial") return "ORDER BY " + quoted_list(table.key);
  return "JOIN (SELECT session_id, max(recorded_realtime_ns) AS newest FROM turnpoint.trial GROUP BY "
         "session_id) x"
         " USING (session_id) ORDER BY newest, session_id, trial_index";
}

void refuse_changed(store::Database& database) {
  for (const auto& session : store::verify_database(database))
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

ReadableDatabase::ReadableDatabase(const std::string& database) : path_(database) {
  if (!is_server(database)) return;
  folder_ = make_folder();
  path_ = folder_ + "/collected.sqlite";
  try {
    fetch(database);
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

void ReadableDatabase::fetch(const std::string& address) {
  Connection server(address);
  require_version(server);
  auto writer = store::open_writer(path_, store::IfMissing::create);
  auto& database = writer.database;
  database.execute("PRAGMA synchronous = OFF");
  const ServerTransaction snapshot(server, "ISOLATION LEVEL REPEATABLE READ READ ONLY");
  store::Transaction transaction(database);
  for (const auto& table : collected_tables())
    receive_rows(server,
                 fmt::format("COPY (SELECT {0} FROM turnpoint.{1} {2}) TO STDOUT (FORMAT binary)",
                             column_list(table), table.name, order_of(table)),
                 table, database);
  transaction.commit();
  refuse_changed(database);
}

}  // namespace turnpoint::collector

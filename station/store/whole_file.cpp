#include "station/store/whole_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <string_view>
#include <utility>
#include <vector>

#include "station/store/files.hpp"
#include "station/store/schema.hpp"
#include "station/store/seal.hpp"
#include "station/system/clocks.hpp"
#include "station/system/uuid.hpp"

namespace turnpoint::store {

namespace {

/// Checks the finished file through a new connection, so that nothing comes from a cache.
void verify(const std::string& path) {
  for (const auto* suffix : kLogSuffixes)
    if (file_size(path + suffix) > 0)
      throw StoreError(ErrorKind::io,
                       fmt::format("{}: SQLite left the file's {} behind; check the disk", path, suffix));
  Database copy(path, Database::Access::immutable);
  require_schema(copy);
  check_pages(copy);
  if (copy.text("SELECT value FROM meta WHERE key = 'database_id'").empty())
    copy.fail(SQLITE_CORRUPT, "the database has no id");
}

/// Creates the file `to`. `make` opens, fills and closes a temporary file, which is then renamed.
void publish(const std::string& to, const std::string& original,
             const std::function<void(const std::string& temporary)>& make) {
  const auto temporary = to + ".new";
  remove_database(temporary);
  try {
    create_private(temporary);
    make(temporary);
    verify(temporary);
    give_to_owner_of_folder(temporary);
    permit_as(original, temporary);
    sync_path(temporary);
    rename_file(temporary, to);
  } catch (...) {
    try {
      remove_database(temporary);
    } catch (const StoreError&) {
      // Ignore this error and report the original one. The next attempt removes the temporary file.
    }
    throw;
  }
  sync_path(folder_of(to));
}

/// Looks for files that show that a database of this name once existed: its log, or an unfinished restore.
/// Returns one of them, or "".
std::string orphan_of(const std::string& path) {
  for (const auto* suffix : {"-wal", "-journal"})
    if (file_size(path + suffix) > 0) return path + suffix;
  return file_exists(path + ".restored") ? path + ".restored" : "";
}

}  // namespace

std::string time_stamp() {
  const auto ns = system::realtime_ns();
  const auto milliseconds = ns / 1'000'000 - (ns % 1'000'000 < 0 ? 1 : 0);
  const auto fraction = (milliseconds % 1000 + 1000) % 1000;  // also before 1970
  const std::time_t seconds = (milliseconds - fraction) / 1000;
  return fmt::format("{:%Y%m%dT%H%M%S}.{:03}Z", fmt::gmtime(seconds), fraction);
}

void check_pages(Database& database) {
  const auto pages = database.text("PRAGMA quick_check(1)");
  if (pages != "ok") database.fail(SQLITE_CORRUPT, "quick_check: " + pages);
  Statement keys(database, "PRAGMA foreign_key_check");
  if (keys.step()) database.fail(SQLITE_CORRUPT, "foreign_key_check: table " + keys.text(0));
}

void check_ends(Database& database) {
  std::vector<std::string> tables;
  Statement names(database, "SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY name");
  while (names.step()) tables.push_back(names.text(0));
  for (const auto& table : tables) database.integer("SELECT 1 FROM \"" + table + "\" LIMIT 1");
  Statement last(database, "SELECT * FROM trial ORDER BY trial_id DESC LIMIT 1");
  if (!last.step()) return;
  for (const auto& [table, key] : {std::pair("session", "status"), std::pair("segment", "segment_index"),
                                   std::pair("block", "run_order"), std::pair("tone", "trial_index"),
                                   std::pair("signal", "trial_index"), std::pair("event", "event_index")}) {
    Statement row(database,
                  fmt::format("SELECT * FROM {} WHERE session_id = ? ORDER BY {} DESC LIMIT 1", table, key));
    row.bind(last.text(1));
    const bool needed = std::string_view("session segment block").find(table) != std::string_view::npos;
    if (!row.step() && needed)
      throw StoreError(ErrorKind::corrupt,
                       fmt::format("database {}: the last trial has no {} row any more; the file was not "
                                   "changed; restore the newest good backup (turnpoint backup "
                                   "--db FILE --dir FOLDER --restore)",
                                   database.path(), table));
  }
}

void refuse_absent(const std::string& path) {
  const auto orphan = orphan_of(path);
  if (orphan.empty())
    throw StoreError(ErrorKind::missing,
                     fmt::format("database {}: there is no such file; check the path", path));
  throw StoreError(
      ErrorKind::missing,
      fmt::format(
          "database {}: there is no such file, but {} is there: the database was removed without its log, or "
          "a restore was interrupted; nothing was changed; restore the newest backup (turnpoint backup --db "
          "FILE --dir FOLDER --restore), or move {} away to begin a new database",
          path, orphan, orphan));
}

void create_file(const std::string& path) {
  if (!orphan_of(path).empty()) refuse_absent(path);
  // An empty log or old shared memory contains no data, so remove them.
  for (const auto* suffix : kLogSuffixes) remove_file(path + suffix);
  publish(path, "", [](const std::string& temporary) {
    // In rollback mode, all data are in this one file once the transaction has ended; publish() makes it
    // durable.
    Database database(temporary, Database::Access::read_write);
    database.execute("PRAGMA journal_mode = DELETE; PRAGMA synchronous = OFF");
    create_schema(database);
    Statement(database, "INSERT INTO meta VALUES ('database_id', ?)").bind(system::new_uuid()).run();
    create_seal(database);
  });
}

void copy_to_file(Database& from, const std::string& to, const std::string& original,
                  const std::function<void(Database&)>& finish) {
  publish(to, original, [&](const std::string& temporary) {
    Database copy(temporary, Database::Access::read_write);
    copy_database(from, copy);
    // Take the copy out of WAL mode, because a file in WAL mode cannot be read on every medium.
    if (copy.text("PRAGMA journal_mode = DELETE") != "delete")
      throw StoreError(ErrorKind::io,
                       "copy " + temporary + ": the copy cannot be taken out of WAL mode; check the disk");
    copy.execute("PRAGMA synchronous = OFF");  // publish() makes the file durable
    if (finish) finish(copy);
  });
}

std::string replace_by_restored(const std::string& path) {
  const auto aside = path + ".damaged-" + time_stamp();
  bool moved = false;
  // Move the database file first. If the program is interrupted after that, there is no database under this
  // name, and every program refuses to create one. In another order, a log without its file, or a new file
  // with an old log, could be mistaken for a database.
  for (const auto* suffix : {"", "-wal", "-journal", "-shm"}) {
    if (!file_exists(path + suffix)) continue;
    rename_file(path + suffix, aside + suffix);
    moved = true;
  }
  sync_path(folder_of(path));
  rename_file(path + ".restored", path);
  sync_path(folder_of(path));
  return moved ? aside : "";
}

void remove_leftovers(const std::string& path) {
  for (const auto* name : {".new", ".merging", ".merging.new", ".restored", ".restored.new"})
    remove_database(path + name);
}

}  // namespace turnpoint::store

#include "station/store/open.hpp"

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <utility>

#include "station/store/files.hpp"
#include "station/store/identity.hpp"
#include "station/store/records.hpp"
#include "station/store/schema.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;

namespace {

enum class FileState { absent, empty, something };

FileState state_of(const std::string& path) {
  std::error_code error;
  const auto size = fs::file_size(path, error);
  if (error == std::errc::no_such_file_or_directory) return FileState::absent;
  if (error) fail_system(Fault::missing, "database " + path, error.value(), "name a file");
  return size == 0 ? FileState::empty : FileState::something;
}

void refuse_empty(const std::string& path) {
  throw StoreError(
      Fault::not_a_database,
      fmt::format("database {}: the file is empty (0 bytes): what was in it is lost, or it never was a "
                  "database; it was left untouched; restore the newest backup (turnpoint backup --db "
                  "FILE --dir FOLDER --restore), or remove it to begin a new one",
                  path));
}

void refuse_absent(const std::string& path) {
  throw StoreError(Fault::missing, fmt::format("database {}: there is no such file; check the path", path));
}

/// A half-made file must never stand under the final name: a later start could not tell it from a lost one.
void create_file(const std::string& path) {
  const auto temporary = path + ".new";
  for (const auto* suffix : {"", "-wal", "-shm", "-journal"}) fs::remove(temporary + suffix);
  {
    Database database(temporary, Database::Access::create);
    database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL");
    create_schema(database, schema_version());
    Statement(database, "INSERT INTO meta VALUES ('database_id', ?)").bind(new_uuid()).run();
  }
  give_to_owner_of_folder(temporary);
  sync_path(temporary);
  fs::rename(temporary, path);
  sync_path(fs::path(path).parent_path().string());
}

void recover_sessions(Database& database) {
  Transaction transaction(database);
  Statement(database, "UPDATE session SET status = 'interrupted', status_reason = ? WHERE status = 'running'")
      .bind(kLostReason)
      .run();
  Statement(
      database,
      "UPDATE session SET status = 'abandoned', status_reason = ? WHERE status = 'interrupted' AND NOT EXISTS"
      " (SELECT 1 FROM trial WHERE trial.session_id = session.session_id)")
      .bind(kAbandonedReason)
      .run();
  transaction.commit();
}

/// SQLite opens a file that it may not write without a word, and for reading only.
void require_writable(Database& database) {
  if (sqlite3_db_readonly(database.handle(), "main") == 0) return;
  throw StoreError(
      Fault::read_only,
      fmt::format("database {}: the file or its disk cannot be written; nothing was changed; make the "
                  "file and its folder writable, or name a database elsewhere",
                  database.path()));
}

/// Some file systems and folders leave no room for the shared memory of WAL mode: then, and only without a
/// log that would be passed over, the file is read as it stands.
Database open_plain_reader(const std::string& path) {
  try {
    Database database(path, Database::Access::read_only);
    database.execute("PRAGMA busy_timeout = 2000");
    database.integer("SELECT count(*) FROM sqlite_schema");
    return database;
  } catch (const StoreError& error) {
    const bool no_shared_memory = error.fault() == Fault::missing || error.fault() == Fault::read_only;
    if (!no_shared_memory || fs::exists(path + "-wal")) throw;
  }
  return Database(path, Database::Access::immutable);
}

/// The lock goes by name: under a second one, another station could write the same file at the same time.
void refuse_second_name(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode) || status.st_nlink < 2) return;
  throw StoreError(
      Fault::busy,
      fmt::format("database {}: the file has a second name (a hard link), by which another station "
                  "could write it at the same time; it was left untouched; remove the other "
                  "name, or copy the file and use the copy",
                  path));
}

}  // namespace

StationLock::StationLock(const std::string& database) {
  refuse_second_name(database);
  descriptor_ = open_lock(database + ".lock");
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
    char owner[64] = {};
    const auto size = ::pread(descriptor_, owner, sizeof owner - 1, 0);
    ::close(std::exchange(descriptor_, -1));
    throw StoreError(
        Fault::busy,
        fmt::format("database {}: another station process{}{} is writing it; end that one first, or "
                    "name another database",
                    database, size > 0 ? ", pid " : "", std::string(owner)));
  }
  const auto owner = std::to_string(::getpid());
  // Only a courtesy to whoever finds the lock taken: a full disk must not keep the station from starting
  // here.
  if (::ftruncate(descriptor_, 0) == 0) (void)!::pwrite(descriptor_, owner.data(), owner.size(), 0);
}

StationLock::StationLock(StationLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

StationLock::~StationLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void check_pages(Database& database) {
  const auto pages = database.text("PRAGMA quick_check(1)");
  if (pages != "ok") database.fail(SQLITE_CORRUPT, "quick_check: " + pages);
  Statement keys(database, "PRAGMA foreign_key_check");
  if (keys.step()) database.fail(SQLITE_CORRUPT, "foreign_key_check: table " + keys.text(0));
}

void copy_to_file(Database& from, const std::string& to, const std::string& original) {
  const auto temporary = to + ".new";
  const auto clean = [&temporary] {
    for (const auto* suffix : {"", "-wal", "-shm", "-journal"}) {
      std::error_code ignored;
      fs::remove(temporary + suffix, ignored);
    }
  };
  clean();
  try {
    create_private(temporary);
    {
      Database copy(temporary, Database::Access::create);
      copy_database(from, copy);
      check_pages(copy);
      // A copy is one file: out of WAL mode it can be read from any medium.
      copy.execute("PRAGMA journal_mode = DELETE");
    }
    give_to_owner_of_folder(temporary);
    permit_as(original, temporary);
    sync_path(temporary);
    fs::rename(temporary, to);
    sync_path(fs::path(to).parent_path().string());
  } catch (...) {
    clean();
    throw;
  }
}

Writer open_writer(const std::string& name, IfMissing if_missing) {
  const auto path = canonical(name);
  if (if_missing == IfMissing::fail && state_of(path) == FileState::absent) refuse_absent(path);
  StationLock lock(path);
  const auto state = state_of(path);
  if (state == FileState::empty) refuse_empty(path);
  if (state == FileState::absent) create_file(path);
  Database database(path, Database::Access::read_write);
  database.execute("PRAGMA busy_timeout = 2000");
  const int version = checked_version(database);
  require_writable(database);
  check_pages(database);
  if (version < schema_version())
    copy_to_file(database, fmt::format("{}.before-v{}", path, schema_version()), path);
  database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  migrate(database);
  recover_sessions(database);
  return {std::move(lock), std::move(database)};
}

Database open_reader(const std::string& name) {
  const auto path = canonical(name);
  const auto state = state_of(path);
  if (state == FileState::absent) refuse_absent(path);
  if (state == FileState::empty) refuse_empty(path);
  auto database = open_plain_reader(path);
  const int version = checked_version(database);
  check_pages(database);
  if (version == schema_version()) return database;
  Database migrated(":memory:", Database::Access::create);
  copy_database(database, migrated);
  migrate(migrated);
  return migrated;
}

}  // namespace turnpoint::store

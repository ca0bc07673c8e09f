#include "station/store/open.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "station/store/files.hpp"
#include "station/store/names.hpp"
#include "station/store/schema.hpp"
#include "station/store/seal.hpp"
#include "station/store/whole_file.hpp"

namespace turnpoint::store {

namespace {

enum class FileState { absent, empty, something };

FileState state_of(const std::string& path) {
  if (!file_exists(path)) return FileState::absent;
  return file_size(path) == 0 ? FileState::empty : FileState::something;
}

void refuse_empty(const std::string& path) {
  throw StoreError(
      ErrorKind::not_a_database,
      fmt::format("database {}: the file is empty (0 bytes): its contents are lost, or it was never a "
                  "database; the file was not changed; restore the newest backup (turnpoint backup --db "
                  "FILE --dir FOLDER --restore), or remove the file to begin a new database",
                  path));
}

void recover_sessions(Database& database) {
  constexpr const char* kEmpty =
      "status = 'interrupted' AND NOT EXISTS (SELECT 1 FROM trial WHERE trial.session_id = "
      "session.session_id)"
      " AND NOT EXISTS (SELECT 1 FROM answer WHERE answer.session_id = session.session_id)";
  if (database.integer(
          fmt::format("SELECT count(*) FROM session WHERE status = 'running' OR ({})", kEmpty)) == 0)
    return;
  SealedTransaction transaction(database);
  Statement(database, "UPDATE session SET status = 'interrupted', status_reason = ? WHERE status = 'running'")
      .bind(kLostReason)
      .run();
  Statement(database,
            fmt::format("UPDATE session SET status = 'abandoned', status_reason = ? WHERE {}", kEmpty))
      .bind(kAbandonedReason)
      .run();
  transaction.commit();
}

/// Throws if the file cannot be written. (SQLite reports no error in that case and opens the file read-only.)
void require_writable(Database& database) {
  if (sqlite3_db_readonly(database.handle(), "main") == 0) return;
  throw StoreError(
      ErrorKind::read_only,
      fmt::format("database {}: the file or its disk cannot be written; nothing was changed; make the "
                  "file and its folder writable, or choose a database in another place",
                  database.path()));
}

/// Copies a file and its log into a temporary database, which SQLite removes when it is closed. Only for a
/// read-only medium: elsewhere, somebody could write between the two copies.
Database copy_with_log(const std::string& path) {
  namespace fs = std::filesystem;
  auto folder = (fs::temp_directory_path() / "turnpoint-XXXXXX").string();
  if (::mkdtemp(folder.data()) == nullptr)
    fail_system(kind_of_errno(errno), "temporary copy of " + path, errno,
                "set TMPDIR to a folder with space");
  try {
    for (const auto* suffix : {"", "-wal"}) fs::copy_file(path + suffix, folder + "/copy" + suffix);
    Database all("", Database::Access::create);
    {
      Database copy(folder + "/copy", Database::Access::read_write);
      copy_database(copy, all);
    }
    fs::remove_all(folder);
    all.set_path(path);
    return all;
  } catch (const std::exception& error) {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    if (dynamic_cast<const StoreError*>(&error) != nullptr) throw;
    throw StoreError(ErrorKind::io,
                     fmt::format("temporary copy of {}, which lies on a read-only medium with its log: {}; "
                                 "set TMPDIR to a folder with space",
                                 path, error.what()));
  }
}

bool is_read_only_medium(const std::string& path) {
  struct statvfs disk {};
  return ::statvfs(path.c_str(), &disk) == 0 && (disk.f_flag & ST_RDONLY) != 0;
}

/// Opens a file for reading. WAL mode needs shared memory beside the file, which some file systems and
/// folders do not allow. The file is then read without shared memory, but only if there is no log; with a
/// log, a copy is read if the medium is read-only.
Database open_plain_reader(const std::string& path) {
  try {
    Database database(path, Database::Access::read_only);
    database.execute("PRAGMA busy_timeout = 2000");
    database.integer("SELECT count(*) FROM sqlite_schema");
    return database;
  } catch (const StoreError& error) {
    const bool no_shared_memory =
        error.kind() == ErrorKind::cannot_open || error.kind() == ErrorKind::read_only;
    if (!no_shared_memory) throw;
    if (file_size(path + "-wal") > 0) {
      if (!is_read_only_medium(path)) throw;
      return copy_with_log(path);
    }
  }
  return Database(path, Database::Access::immutable);
}

/// Throws if a file has two names (hard links). Each name has a lock file of its own, so a second station
/// could lock the other name and write to the file at the same time.
void refuse_second_name(const std::string& path) {
  struct stat status {};
  if (::lstat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode) || status.st_nlink < 2) return;
  throw StoreError(
      ErrorKind::busy,
      fmt::format("database {}: the file has a second name (a hard link), through which another station "
                  "could write to it at the same time; the file was not changed; remove the other "
                  "name, or copy the file and use the copy",
                  path));
}

/// The content of a lock file: the process that holds it and the database's id, as "PID\nID\n".
struct LockNote {
  std::string process, database_id;
};

LockNote note_in(int descriptor) {
  char bytes[128] = {};
  const auto size = ::pread(descriptor, bytes, sizeof bytes - 1, 0);
  const std::string text(bytes, size > 0 ? static_cast<std::size_t>(size) : 0);
  const auto end = text.find('\n');
  LockNote note{text.substr(0, end), end == std::string::npos ? "" : text.substr(end + 1, 36)};
  if (note.database_id.size() != 36) note.database_id.clear();
  return note;
}

}  // namespace

StationLock::StationLock(const std::string& database) {
  refuse_second_name(database);
  lock_ = open_lock(database + ".lock");
  const auto found = note_in(lock_.get());
  const bool locked = ::flock(lock_.get(), LOCK_EX | LOCK_NB) == 0;
  if (!locked && errno != EWOULDBLOCK && errno != EINTR)
    fail_system(
        ErrorKind::io, "locking " + database + ".lock", errno,
        "this file system cannot lock files, so that two stations could write to the database at the same "
        "time; keep it on a disk of this machine, with ext4");
  if (!locked)
    throw StoreError(ErrorKind::busy,
                     fmt::format("database {}: another station process{}{} is writing to it; end that "
                                 "process first, or name another database",
                                 database, found.process.empty() ? "" : ", pid ", found.process));
  note(found.database_id);
}

void StationLock::remember(const std::string& database_id) { note(database_id); }

/// Writes the process id and the database's id into the lock file. A failure, for example on a full disk, is
/// ignored: the text only helps somebody who finds the lock taken or the database lost.
void StationLock::note(const std::string& database_id) {
  const auto text = fmt::format("{}\n{}{}", ::getpid(), database_id, database_id.empty() ? "" : "\n");
  if (::pwrite(lock_.get(), text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()))
    (void)!::ftruncate(lock_.get(), static_cast<off_t>(text.size()));
}

std::string remembered_database_id(const std::string& database) {
  const core::FileDescriptor lock(::open((database + ".lock").c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
  return lock.is_open() ? note_in(lock.get()).database_id : "";
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
  require_schema(database);
  require_no_trigger(database);
  require_writable(database);
  check_ends(database);
  remove_leftovers(path);
  database.execute("PRAGMA journal_mode = WAL; PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON");
  recover_sessions(database);
  lock.remember(database.text("SELECT value FROM meta WHERE key = 'database_id'"));
  return {std::move(lock), std::move(database)};
}

Database open_reader(const std::string& name) {
  const auto path = canonical(name);
  const auto state = state_of(path);
  if (state == FileState::absent) refuse_absent(path);
  if (state == FileState::empty) refuse_empty(path);
  auto database = open_plain_reader(path);
  require_schema(database);
  check_ends(database);
  return database;
}

}  // namespace turnpoint::store

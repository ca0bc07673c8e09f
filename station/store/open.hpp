#pragma once
#include <string>

#include "station/core/file_descriptor.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// A lock for the one process that may write a database: an flock on FILE.lock beside the database. The
/// kernel releases it, however the process ends. Move-only.
class StationLock {
 public:
  /// Throws StoreError (busy) if another process has the lock. The message gives that process's id.
  explicit StationLock(const std::string& database);

  /// Stores the database's id in the lock file. If the database is lost, this id identifies its backups.
  void remember(const std::string& database_id);

 private:
  void note(const std::string& database_id);
  core::FileDescriptor lock_;
};

/// Returns the id that remember() stored beside this database, even if the database itself is lost; "" if
/// there is none.
std::string remembered_database_id(const std::string& database);

/// A connection for writing, and the lock that protects it.
struct Writer {
  StationLock lock;
  Database database;
};

/// What open_writer() does if the file does not exist.
enum class IfMissing { create, fail };

/// Opens a database for writing (WAL, synchronous FULL, foreign keys).
/// - It checks the file with check_ends(), which takes no longer for a large file than for a small one.
/// - It refuses a database with triggers that the program has not made.
/// - It creates a missing file under another name and renames it when it is complete.
/// - It removes what interrupted operations have left beside the database.
/// - If root creates files in another user's folder, including the lock, it gives them to that user.
/// - Sessions that a dead process left running become interrupted; those without trials become abandoned.
/// Throws StoreError and changes nothing if the file is empty, damaged, of another schema, or not
/// Turnpoint's.
Writer open_writer(const std::string& path, IfMissing if_missing);

/// Opens a database for reading only, and checks it with check_ends(). This works while a session is running,
/// and on a read-only disk. Before copying or verifying the whole file, call check_pages() too.
Database open_reader(const std::string& path);

}  // namespace turnpoint::store

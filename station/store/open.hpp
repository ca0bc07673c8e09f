#pragma once
#include <string>

#include "station/store/sqlite.hpp"
#include "station/system/file_descriptor.hpp"

namespace turnpoint::store {

/// Held by the one process that may write a database. It is an flock on FILE.lock beside the database, which
/// the kernel releases however the process ends. Move-only.
class StationLock {
 public:
  /// Throws StoreError (busy) that names the process holding the lock.
  explicit StationLock(const std::string& database);

  /// Stores the database's id in the lock file. If the database is lost, the id tells which backups are its
  /// own.
  void remember(const std::string& database_id);

 private:
  void note(const std::string& database_id);
  system::FileDescriptor lock_;
};

/// The id that remember() stored beside this database, available even after the file itself is lost; "" if
/// there is none.
std::string remembered_database_id(const std::string& database);

/// A lock and the write connection that it protects.
struct Writer {
  StationLock lock;
  Database database;
};

/// What open_writer does if there is no file.
enum class IfMissing { create, fail };

/// Opens a database for writing (WAL, synchronous FULL, foreign keys).
/// Checks the file with check_ends(), which takes no longer for a large file than for a small one.
/// Migrates an older schema after making a copy FILE.before-vN.
/// A new file appears complete or not at all.
/// Removes what interrupted operations have left beside the database.
/// Files that root creates in another user's folder, including the lock, are given to that user.
/// Sessions that a dead process left running become interrupted; those without trials become abandoned.
/// Throws StoreError and changes nothing if the file is empty, damaged, newer, or not Turnpoint's.
Writer open_writer(const std::string& path, IfMissing if_missing);

/// Opens a database for reading only, and checks it with check_ends(). This works while a session is running
/// and on a read-only disk. If you copy or judge the whole file, call check_pages() too. An older schema is
/// read through a migrated copy in a temporary file.
Database open_reader(const std::string& path);

}  // namespace turnpoint::store

#pragma once
#include <string>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// Held by the one process that may write a database: an flock on FILE.lock beside it, given back by the
/// kernel however the process ends. Move-only.
class StationLock {
 public:
  /// Throws StoreError (busy) naming the process that has it.
  explicit StationLock(const std::string& database);
  StationLock(StationLock&& other) noexcept;
  StationLock& operator=(StationLock&&) = delete;
  ~StationLock();

  /// Notes in the lock file whose database it guards: what tells a lost file's backups from others.
  void remember(const std::string& database_id);

 private:
  void note(const std::string& database_id);
  int descriptor_ = -1;
};

/// What remember() has noted beside this database, also after the file itself is lost; "" for nothing.
std::string remembered_database_id(const std::string& database);

/// A lock and the write connection under it.
struct Writer {
  StationLock lock;
  Database database;
};

/// What open_writer does where there is no file.
enum class IfMissing { create, fail };

/// Opens a database for writing: WAL, synchronous FULL, foreign keys; checks its ends (check_ends()), which
/// takes as long for a large file as for a small one, and takes an older schema to the current one after a
/// copy FILE.before-vN. A new file appears whole or not at all. What interrupted operations have left beside
/// the database is removed. What root makes anew in another user's folder, the lock as well, is that user's.
/// Sessions that a dead process left running become interrupted, those without trials abandoned. Throws
/// StoreError and changes nothing for a file that is empty, damaged, not Turnpoint's or newer.
Writer open_writer(const std::string& path, IfMissing if_missing);

/// Opens a database for reading only, also beside a running session and on a read-only disk, and checks its
/// ends. Whoever copies or judges the whole of it calls check_pages() as well. An older schema is read
/// through a migrated copy in a temporary file.
Database open_reader(const std::string& path);

}  // namespace turnpoint::store

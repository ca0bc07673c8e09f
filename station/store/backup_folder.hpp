#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"
#include "station/system/file_descriptor.hpp"

namespace turnpoint::store {

/// A backup found in a folder. Its meta table, not its file name, says which database it is a backup of.
struct StoredBackup {
  std::string path;
  std::string database_id;  ///< id of the database; "" if the backup cannot be read
  std::string station;      ///< station of one of its sessions; "" if it has no session
  std::string stem;         ///< file name of the database when the backup was made, without folder and ending
  /// increases with each backup made into the folder; 0 for backups of older releases
  std::int64_t number = 0;
  std::int64_t made_realtime_ns = 0;  ///< time given in the file name
  std::string trouble;  ///< why the backup could not be read; "" if it was read, or is known to be damaged
  bool readable() const { return !database_id.empty(); }
};

/// All backups in a folder, of any database, ordered by number and then by name (oldest first). Files with
/// other names are ignored. Throws StoreError if the folder cannot be listed.
std::vector<StoredBackup> stored_backups(const std::string& folder);

/// A number greater than that of every backup in the folder, of any database.
std::int64_t next_backup_number(const std::string& folder);

/// Writes the values of a StoredBackup into a copy. clear_backup_note() removes them from a restored
/// database.
void write_backup_note(Database& copy, const std::string& stem, std::int64_t number);
void clear_backup_note(Database& copy);

/// Removes a backup and its checksum file.
void remove_backup(const std::string& path);

/// A lock for the one process that changes a folder of backups; others wait. Has no effect on file systems
/// without locks.
class BackupFolderLock {
 public:
  explicit BackupFolderLock(const std::string& folder);

 private:
  system::FileDescriptor lock_;
};

/// Throws StoreError (missing) unless a disk other than the database's is mounted at the folder or at its
/// parent folder. Without its disk, a mount point is just an empty folder on the system disk.
void require_disk(const std::string& folder, const std::string& database);

/// The file into which a drill restores a backup. If it is left behind, it is removed like the files of an
/// interrupted backup.
std::string drill_file(const std::string& backup);

/// Removes the unfinished files of interrupted backups from a folder, while holding the folder's lock.
/// Returns what was removed.
std::vector<std::string> remove_interrupted_backups(const std::string& folder);

}  // namespace turnpoint::store

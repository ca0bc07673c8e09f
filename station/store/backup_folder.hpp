#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// A backup as it stands in a folder. What it is a backup of it says itself, in its meta table, not by its
/// name.
struct StoredBackup {
  std::string path;
  std::string database_id;  ///< "" where it cannot be read
  std::string station;      ///< of one of its sessions, "" where it has none
  std::string stem;         ///< name of the database without folder and ending, when the backup was made
  std::int64_t number = 0;  ///< rises with each backup made into the folder; 0 in those of older releases
  std::int64_t made_realtime_ns = 0;  ///< by its name
  std::string trouble;  ///< what kept it from being read, where that is not known to be damage; "" otherwise
  bool readable() const { return !database_id.empty(); }
};

/// All backups in a folder, of whatever database, oldest first: by number, then by name. Files with other
/// names are not among them. Throws StoreError where the folder cannot be listed.
std::vector<StoredBackup> stored_backups(const std::string& folder);

/// Above the number of every backup in the folder, of whatever database.
std::int64_t next_backup_number(const std::string& folder);

/// Writes into a copy what a StoredBackup says; clear_backup_note() takes it away from a restored database.
void write_backup_note(Database& copy, const std::string& stem, std::int64_t number);
void clear_backup_note(Database& copy);

/// Removes a backup with its checksum.
void remove_backup(const std::string& path);

/// Held by the one process that changes a folder of backups; others wait. Not on file systems without locks.
class BackupFolderLock {
 public:
  explicit BackupFolderLock(const std::string& folder);
  BackupFolderLock(const BackupFolderLock&) = delete;
  BackupFolderLock& operator=(const BackupFolderLock&) = delete;
  ~BackupFolderLock();

 private:
  int descriptor_ = -1;
};

/// Throws StoreError (missing) unless a disk other than the database's is mounted at the folder or at the one
/// above it: without its disk a mount point is an empty folder on the system's.
void require_disk(const std::string& folder, const std::string& database);

/// Where a drill restores a backup to: its leftovers are removed as those of an interrupted backup.
std::string drill_file(const std::string& backup);

/// Removes what interrupted backups have left in a folder: files that never got their name. Under its lock.
/// Returns what was removed.
std::vector<std::string> remove_interrupted_backups(const std::string& folder);

}  // namespace turnpoint::store

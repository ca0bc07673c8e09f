#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/core/file_descriptor.hpp"
#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// A backup that was found in a folder. The meta table in the backup says which database was backed up; the
/// file name does not matter.
struct StoredBackup {
  std::string path;
  std::string database_id;  ///< id of the backed-up database; "" if the backup cannot be read
  std::string station;      ///< station of one of the sessions in the backup; "" if there are no sessions
  std::string machine;      ///< identity of the machine that made the backup (station.hpp); "" if not known
  /// file name of the database at the time of the backup, without folder and ending
  std::string stem;
  std::int64_t number = 0;            ///< increases with each backup in the folder
  std::int64_t made_realtime_s = 0;  ///< time of the backup since 1970, read from its file name
  /// error that prevented reading the backup; "" if it could be read or is known to be damaged
  std::string trouble;
  bool readable() const { return !database_id.empty(); }
  /// True if a machine other than this one has made the backup: of the original, if this one has a copy.
  bool is_of_other_machine(const std::string& machine_here) const {
    return !machine.empty() && !machine_here.empty() && machine != machine_here;
  }
};

/// Returns the backups of all databases in a folder, ordered by number and then by name (oldest first). Files
/// with other names are ignored. Throws StoreError if the folder cannot be listed.
std::vector<StoredBackup> stored_backups(const std::string& folder);

/// Returns a number greater than that of any backup in the folder, whichever database it belongs to.
std::int64_t next_backup_number(const std::string& folder);

/// Writes the database's file name (stem), the number of the backup and the machine into the backup.
/// clear_backup_note() removes them after the backup was restored.
void write_backup_note(Database& copy, const std::string& stem, std::int64_t number);
void clear_backup_note(Database& copy);

/// Removes a backup and its checksum file.
void remove_backup(const std::string& path);

/// Holds the lock of a folder of backups. Only the process that holds it may change the folder; other
/// processes wait for it. On file systems without locks it does nothing.
class BackupFolderLock {
 public:
  explicit BackupFolderLock(const std::string& folder);

 private:
  core::FileDescriptor lock_;
};

/// Throws StoreError (missing) unless a separate disk is mounted at the folder or at its parent folder. The
/// database's own disk does not count. (If a disk is not mounted, its mount point is an ordinary empty folder
/// on the system disk.)
void require_disk(const std::string& folder, const std::string& database);

/// Returns the name of the temporary file into which a drill (a trial restore) restores a backup. If the
/// drill is killed, this file is removed together with the files of interrupted backups.
std::string drill_file(const std::string& backup);

/// Removes the unfinished files of interrupted backups from a folder, and returns their names. Holds the
/// folder's lock while it does so.
std::vector<std::string> remove_interrupted_backups(const std::string& folder);

}  // namespace turnpoint::store

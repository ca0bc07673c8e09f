#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

enum class Destination {
  folder,  ///< the folder to write to (any); created if missing
  disk,    ///< a folder on a separate disk, stick or share; refused if none is mounted
};

struct BackupOptions {
  std::string directory;
  int keep = 10;  ///< number of newest backups of this database to keep, including the new one; 0 keeps all
  Destination destination = Destination::folder;
};

struct BackupReport {
  std::string path;
  std::string sha256;  ///< checksum of the file, also stored beside it in FILE.sha256
  std::uint64_t bytes = 0;
  std::int64_t number = 0;  ///< increases with each backup made into the folder, even if the clock goes back
  std::int64_t sessions = 0, trials = 0;
  std::vector<std::string> removed;  ///< older backups that rotation removed
  std::string unrecorded;            ///< why last_backup() will not find this backup; "" if it will
};

/// Copies a database to `directory`/NAME-NUMBER-TIME.sqlite, even while a session is writing to it. The copy
/// is synced, read back and checked before it gets its name. Only then does rotation remove older backups of
/// the same database, so a damaged database never replaces good backups. Throws StoreError.
BackupReport backup(const std::string& database, const BackupOptions& options);

/// The newest backup of a database that was read back and checked, wherever it is now.
struct LastBackup {
  std::string path;
  std::int64_t realtime_ns = 0;  ///< wall-clock time at which it was made
};

/// The note that the last backup left beside this database (FILE.last-backup); empty if none was made. Reads
/// two small files and does not touch the disk that holds the backups.
std::optional<LastBackup> last_backup(const std::string& database);

/// The backups of this database in a folder, oldest first. They are recognised by the database's id, not by
/// file name. Throws StoreError.
std::vector<std::string> backups_in(const std::string& directory, const std::string& database);

struct RestoreOptions {
  std::string directory;
  /// id of the database whose backups to use; "" finds it from what is left of the lost database
  std::string database_id;
};

struct Restoration {
  std::string from;  ///< the backup that was used
  std::string database_id;
  std::string quarantined;  ///< where the damaged database was moved to; "" if there was none
  std::int64_t sessions = 0, trials = 0;
  std::vector<std::string> rejected;  ///< backups of this database that failed their check
  /// Sessions whose rows differ from what was recorded (see checksum.hpp). They were changed before the
  /// backup was made, so the backup contains the change.
  std::vector<std::string> changed;
};

/// Replaces a missing, empty or damaged database by its newest good backup. The old file and its log are
/// moved aside and never overwritten. The backups are chosen by the database's id, which is read from the
/// damaged file or its lock file. If neither tells, the backups made of a database with this file name are
/// used, provided that they all have the same id. Throws StoreError: refused if the database is good,
/// conflict if the backups belong to several databases, and the original error if the database cannot be
/// opened but is not known to be damaged.
Restoration restore_backup(const std::string& database, const RestoreOptions& options);

/// The result of restoring the newest backup into a temporary file.
struct Drill {
  std::string from;
  std::int64_t number = 0;
  double age_s = 0;  ///< age of the backup, from the time in its file name
  std::int64_t sessions = 0, trials = 0, live_sessions = 0, live_trials = 0;
  std::vector<std::string> problems;  ///< empty if a restore would bring back everything that was recorded
};

/// Restores the newest backup of a database into a temporary file beside it. Checks pages, references and
/// every checksum, and compares its sessions with those of the database. Leaves no file behind. Throws
/// StoreError if the newest backup cannot be restored at all.
Drill drill_restore(const std::string& database, const std::string& directory);

/// Throws StoreError (corrupt) if a FILE.sha256 exists beside the file and does not match it.
void verify_checksum_file(const std::string& path);

}  // namespace turnpoint::store

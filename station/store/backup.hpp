#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/store/error.hpp"
#include "station/store/station.hpp"

namespace turnpoint::store {

enum class Destination {
  folder,  ///< any folder; it is created if missing
  disk,    ///< a folder on a separate disk, stick or share; refused if no disk is mounted there
};

struct BackupOptions {
  std::string directory;
  int keep = 10;  ///< number of backups of this database to keep, the new one included; 0 keeps all
  Destination destination = Destination::folder;
};

struct BackupReport {
  std::string path;
  std::string sha256;  ///< checksum of the file, also stored beside it in FILE.sha256
  std::uint64_t bytes = 0;
  /// number of the backup in its folder; increases with each backup, even if the clock is set back
  std::int64_t number = 0;
  std::int64_t sessions = 0, trials = 0;
  std::vector<std::string> removed;  ///< older backups that were removed to keep only `keep`
  std::string unrecorded;            ///< why last_backup() will not report this backup; "" if it will
};

/// Copies a database to `directory`/NAME-NUMBER-TIME.sqlite, even while a session is writing to it. The copy
/// is synced, read back and checked before it gets this name. Only then are older backups of the same
/// database removed, so a damaged database never replaces good backups. Throws StoreError.
BackupReport backup(const std::string& database, const BackupOptions& options);

/// The newest backup of a database that was read back and checked. Somebody may have moved the file since
/// then.
struct LastBackup {
  std::string path;
  std::int64_t realtime_ns = 0;  ///< wall-clock time at which it was made
};

/// Reads the record that the last backup left beside the database (FILE.last-backup); empty if there is none.
/// Reads two small files and does not touch the disk that holds the backups.
std::optional<LastBackup> last_backup(const std::string& database);

/// Returns the backups of this database in a folder, oldest first. It recognises them by the database's id,
/// not by their file names. Throws StoreError.
std::vector<std::string> backups_in(const std::string& directory, const std::string& database);

struct RestoreOptions {
  std::string directory;
  /// id of the database whose backups to use; if "", the damaged file or its lock file gives the id
  std::string database_id;
  /// moved: this machine replaces the one that has made the backup
  Whose whose = Whose::found;
};

struct Restoration {
  std::string from;  ///< path of the backup that was used
  std::string database_id;
  std::string quarantined;  ///< path to which the damaged database was moved; "" if there was none
  std::int64_t sessions = 0, trials = 0;
  std::vector<std::string> rejected;  ///< backups of this database that failed the check
  /// Sessions whose rows do not match their recorded checksums (see checksum.hpp). The backup already
  /// contained these changes.
  std::vector<std::string> changed;
  std::vector<std::string> problems;  ///< of the file as a whole (file_problems in verify.hpp), likewise
};

/// Replaces a missing, empty or damaged database by its newest good backup. The old file and its log are
/// moved aside and never overwritten. The backups are found by the database's id, which is read from the
/// damaged file or from its lock file. If neither contains the id, the backups with the database's file name
/// are used, provided that they all have the same id.
///
/// Throws StoreError: refused if the database is good, conflict if the backups belong to several databases,
/// other_machine if only another machine has made backups of it.
/// If the database cannot be opened but is not known to be damaged, throws the error of opening it.
Restoration restore_backup(const std::string& database, const RestoreOptions& options);

/// The result of restoring the newest backup into a temporary file.
struct Drill {
  std::string from;
  std::int64_t number = 0;
  double age_s = 0;  ///< age of the backup according to the time in its file name
  std::int64_t sessions = 0, trials = 0, live_sessions = 0, live_trials = 0;
  /// empty if a restored backup would contain everything that was recorded
  std::vector<std::string> problems;
};

/// Restores the newest backup of a database into a temporary file beside the backup, as an exercise. Checks
/// pages, references and every checksum, and compares the sessions with those of the database. Leaves no file
/// behind. Throws StoreError if the newest backup cannot be restored at all.
Drill drill_restore(const std::string& database, const std::string& directory);

/// Checks a file against the checksum in FILE.sha256, if that file exists. Throws StoreError (corrupt) if
/// they differ.
void verify_checksum_file(const std::string& path);

}  // namespace turnpoint::store

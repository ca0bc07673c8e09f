#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

enum class Destination {
  folder,  ///< any folder, made where it is missing
  disk,    ///< a folder on a disk, stick or share of its own: refused where none is mounted
};

struct BackupOptions {
  std::string directory;
  int keep = 10;  ///< newest backups of this database that stay, the one just made among them; 0 keeps all
  Destination destination = Destination::folder;
};

struct BackupReport {
  std::string path;
  std::string sha256;  ///< of the file; stands beside it in FILE.sha256
  std::uint64_t bytes = 0;
  std::int64_t number = 0;  ///< rises with each backup made into the folder, whatever the clock says
  std::int64_t sessions = 0, trials = 0;
  std::vector<std::string> removed;  ///< older backups that rotation took
  std::string unrecorded;            ///< why last_backup() does not know of it; "" where it does
};

/// Copies a database, also one that a session is writing, to `directory`/NAME-NUMBER-TIME.sqlite: durable,
/// read back and checked before it gets its name, and only then are older ones of the same database rotated
/// out. A damaged database is not copied over good backups. Throws StoreError.
BackupReport backup(const std::string& database, const BackupOptions& options);

/// The newest backup of a database that was read back and checked, wherever it lies now.
struct LastBackup {
  std::string path;
  std::int64_t realtime_ns = 0;  ///< wall clock when it was made
};

/// What the last backup of this database has noted beside it (FILE.last-backup); none where none was made.
/// Reads two small files and nothing on the disk of the backups.
std::optional<LastBackup> last_backup(const std::string& database);

/// The backups of this database (by its id, whatever they are called) in a folder, oldest first. Throws
/// StoreError.
std::vector<std::string> backups_in(const std::string& directory, const std::string& database);

struct RestoreOptions {
  std::string directory;
  std::string database_id;  ///< whose backups; "" takes what is known of the lost database
};

struct Restoration {
  std::string from;  ///< the backup that was taken
  std::string database_id;
  std::string quarantined;  ///< where the damaged file is now; "" where there was none
  std::int64_t sessions = 0, trials = 0;
  std::vector<std::string> rejected;  ///< backups of it that failed their check
  /// Sessions whose rows are not as they were recorded (checksum.hpp): the backup holds them so, since they were
  /// changed before it was made.
  std::vector<std::string> changed;
};

/// Puts the newest good backup in the place of a missing, empty or damaged database, which is moved aside
/// with its log and never overwritten. Whose backups: those with the database's id, which the damaged file or
/// its lock file still tells; otherwise those that were made of a database of this name, if that is only one.
/// Throws StoreError: refused where the database is good, conflict where several databases come into
/// question, and whatever keeps a database from being opened that is not known to be damaged.
Restoration restore_backup(const std::string& database, const RestoreOptions& options);

/// What restoring the newest backup into a temporary file has shown.
struct Drill {
  std::string from;
  std::int64_t number = 0;
  double age_s = 0;  ///< by the time in its name
  std::int64_t sessions = 0, trials = 0, live_sessions = 0, live_trials = 0;
  std::vector<std::string> problems;  ///< empty where a restore would bring back what was recorded
};

/// Restores the newest backup of a database into a temporary file beside that, checks pages, references and
/// every checksum, and compares its sessions with those of the database. Leaves nothing behind. Throws
/// StoreError where the newest backup cannot be restored at all.
Drill drill_restore(const std::string& database, const std::string& directory);

/// Throws StoreError (corrupt) where FILE.sha256 stands beside a file and does not agree with it.
void verify_checksum_file(const std::string& path);

}  // namespace turnpoint::store

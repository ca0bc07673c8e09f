#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

struct BackupOptions {
  std::string directory;
  int keep = 10;  ///< newest backups of this database that stay, the one just made among them; 0 keeps all
};

struct BackupReport {
  std::string path;
  std::string sha256;  ///< of the file; stands beside it in FILE.sha256
  std::uint64_t bytes = 0;
  std::int64_t number = 0;  ///< rises with each backup made into the folder, whatever the clock says
  std::int64_t sessions = 0, trials = 0;
  std::vector<std::string> removed;  ///< older backups that rotation took
};

/// Copies a database, also one that a session is writing, to `directory`/NAME-NUMBER-TIME.sqlite: durable,
/// read back and checked before it gets its name, and only then are older ones of the same database rotated
/// out. A damaged database is not copied over good backups. Throws StoreError.
BackupReport backup(const std::string& database, const BackupOptions& options);

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

/// Throws StoreError (corrupt) where FILE.sha256 stands beside a file and does not agree with it.
void verify_checksum_file(const std::string& path);

}  // namespace turnpoint::store

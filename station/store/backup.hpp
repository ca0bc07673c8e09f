#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/store/error.hpp"

namespace turnpoint::store {

struct BackupOptions {
  std::string directory;
  int keep = 10;  ///< newest backups of this database that stay; 0 keeps all
};

struct BackupReport {
  std::string path;
  std::string sha256;  ///< of the file; stands beside it in FILE.sha256
  std::uint64_t bytes = 0;
  std::int64_t sessions = 0, trials = 0;
  std::vector<std::string> removed;  ///< older backups that rotation took
};

/// Copies a database, also one that a session is writing, to `directory`/NAME-TIME.sqlite: durable, read back
/// and checked before it gets its name, and only then are older ones rotated out. A damaged database is not
/// copied over good backups. Throws StoreError.
BackupReport backup(const std::string& database, const BackupOptions& options);

/// The backups of this database in a folder, oldest first.
std::vector<std::string> backups_in(const std::string& directory, const std::string& database);

struct Restoration {
  std::string from;         ///< the backup that was taken
  std::string quarantined;  ///< where the damaged file is now; "" where there was none
  std::int64_t sessions = 0, trials = 0;
  std::vector<std::string> rejected;  ///< newer backups that failed their check
};

/// Puts the newest good backup in the place of a missing, empty or damaged database, which is moved aside
/// with its log and never overwritten. Throws StoreError: refused where the database is good.
Restoration restore_backup(const std::string& database, const std::string& directory);

/// Throws StoreError (corrupt) where FILE.sha256 stands beside a file and does not agree with it.
void verify_checksum_file(const std::string& path);

}  // namespace turnpoint::store

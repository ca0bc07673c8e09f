#pragma once
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// Files beside a database that contain some of the given sessions, or that cannot be read and therefore may
/// contain them.
struct Copies {
  std::vector<std::string> own;  ///< backups of this database
  /// Files that must not be removed without asking: backups of other databases, damaged files that were set
  /// aside, and files that cannot be read.
  std::vector<std::string> foreign;
};

/// Searches the folder of the database, and a folder of backups unless `backup_folder` is "". Throws
/// StoreError if a folder cannot be listed.
Copies copies_of(const std::string& path, Database& database, const std::string& backup_folder,
                 const std::vector<std::string>& session_ids);

/// Removes the files in `own`, and the files that interrupted backups have left in the folder of backups.
void remove_copies(const Copies& copies, const std::string& backup_folder);

}  // namespace turnpoint::store

#pragma once
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// Files that contain some of the requested sessions, or that cannot be read and may contain them.
struct Copies {
  std::vector<std::string> own;  ///< this database's backups, and its copies from before a migration
  /// Files that must not be removed without asking: backups of other databases, damaged files that were set
  /// aside, and files that cannot be read.
  std::vector<std::string> foreign;
};

/// Searches the folder of the database and, unless it is "", a folder of backups. Throws StoreError if a
/// folder cannot be listed.
Copies copies_of(const std::string& path, Database& database, const std::string& backup_folder,
                 const std::vector<std::string>& session_ids);

/// Removes `own`, and the leftovers of interrupted backups in the folder.
void remove_copies(const Copies& copies, const std::string& backup_folder);

}  // namespace turnpoint::store

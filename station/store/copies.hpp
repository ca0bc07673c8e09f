#pragma once
#include <string>
#include <vector>

#include "station/store/sqlite.hpp"

namespace turnpoint::store {

/// Files that hold some of the sessions asked for, or that cannot be read and so may hold them.
struct Copies {
  std::vector<std::string> own;      ///< this database's backups, and its copies before a migration
  std::vector<std::string> foreign;  ///< not to be removed without asking: backups of other databases,
                                     ///< damaged files that were set aside, files that cannot be read
};

/// Looks beside the database and, unless it is "", into a folder of backups. Throws StoreError where a folder
/// cannot be listed.
Copies copies_of(const std::string& path, Database& database, const std::string& backup_folder,
                 const std::vector<std::string>& session_ids);

/// Removes `own`, and what interrupted backups have left in the folder.
void remove_copies(const Copies& copies, const std::string& backup_folder);

}  // namespace turnpoint::store

#include "station/store/copies.hpp"

#include <algorithm>
#include <filesystem>

#include "station/store/backup_folder.hpp"
#include "station/store/files.hpp"
#include "station/store/schema.hpp"

namespace turnpoint::store {

namespace {

enum class Holds { no, yes, unreadable };

Holds holds(const std::string& path, const std::vector<std::string>& session_ids) {
  try {
    for (const auto* suffix : {"-wal", "-journal"})
      // Data in SQLite's log are not yet in the database file, so reading only that file could miss a
      // session.
      if (file_size(path + suffix) > 0) return Holds::unreadable;
    Database copy(path, Database::Access::immutable);
    require_schema(copy);
    Statement rows(copy, "SELECT 1 FROM session WHERE session_id = ?");
    return std::any_of(session_ids.begin(), session_ids.end(),
                       [&](const auto& id) { return rows.bind(id).step(); })
               ? Holds::yes
               : Holds::no;
  } catch (const StoreError&) {
    return Holds::unreadable;
  }
}

bool is_log(const std::string& name) {
  return std::any_of(std::begin(kLogSuffixes), std::end(kLogSuffixes),
                     [&](const char* suffix) { return name.ends_with(suffix); });
}

}  // namespace

Copies copies_of(const std::string& path, Database& database, const std::string& backup_folder,
                 const std::vector<std::string>& session_ids) {
  Copies copies;
  const auto stem = std::filesystem::path(path).filename().string();
  for (const auto& name : list_folder(folder_of(path))) {
    if (!name.starts_with(stem + ".damaged-") || is_log(name)) continue;
    const auto file = folder_of(path) + "/" + name;
    if (holds(file, session_ids) != Holds::no) copies.foreign.push_back(file);
  }
  if (backup_folder.empty()) return copies;
  const auto id = database.text("SELECT value FROM meta WHERE key = 'database_id'");
  for (const auto& backup : stored_backups(canonical(backup_folder))) {
    const auto found = holds(backup.path, session_ids);
    if (found == Holds::no) continue;
    (found == Holds::yes && backup.database_id == id ? copies.own : copies.foreign).push_back(backup.path);
  }
  return copies;
}

void remove_copies(const Copies& copies, const std::string& backup_folder) {
  for (const auto& path : copies.own) {
    remove_backup(path);
    sync_path(folder_of(path));
  }
  if (backup_folder.empty()) return;
  const auto folder = canonical(backup_folder);
  const BackupFolderLock lock(folder);
  remove_interrupted_backups(folder);
  sync_path(folder);
}

}  // namespace turnpoint::store

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "station/store/backup.hpp"
#include "station/store/backup_folder.hpp"
#include "station/store/checksum.hpp"
#include "station/store/files.hpp"
#include "station/store/open.hpp"
#include "station/store/schema.hpp"
#include "station/store/station.hpp"
#include "station/store/verify.hpp"
#include "station/store/whole_file.hpp"

namespace turnpoint::store {

namespace {

/// Throws unless the database is lost or known to be damaged. A database that cannot be opened or read at the
/// moment may still be intact, and must not be replaced.
void require_lost(const std::string& path) {
  try {
    auto database = open_reader(path);
    check_pages(database);
  } catch (const StoreError& error) {
    const auto kind = error.kind();
    const bool absent = kind == ErrorKind::missing && !file_exists(path);
    if (absent || kind == ErrorKind::corrupt || kind == ErrorKind::not_a_database) return;
    throw;
  }
  throw StoreError(ErrorKind::refused,
                   fmt::format("restore: database {} is intact; nothing was changed; to go back to a backup "
                               "anyway, first move the database away, and {}-wal too if it exists",
                               path, path));
}

/// Returns the database's id from the damaged file, otherwise from its lock file; "" if neither has it.
std::string id_of_lost(const std::string& path) {
  try {
    Database damaged(path, Database::Access::immutable);
    require_schema(damaged);
    const auto id = damaged.text("SELECT value FROM meta WHERE key = 'database_id'");
    if (id.size() == 36) return id;
  } catch (const StoreError&) {
    // The meta table is damaged too, so read the id from the lock file.
  }
  return remembered_database_id(path);
}

[[noreturn]] void refuse_ambiguous(const std::string& path, const std::vector<StoredBackup>& backups) {
  std::string list;
  std::set<std::string> told;
  for (auto backup = backups.rbegin(); backup != backups.rend(); ++backup)
    if (told.insert(backup->database_id).second)
      list +=
          fmt::format("; {} (of station {}, newest {})", backup->database_id, backup->station, backup->path);
  throw StoreError(
      ErrorKind::conflict,
      fmt::format("restore: it is not known which database {} was, and the folder contains backups of {} "
                  "databases; nothing was changed; choose one with --database-id{}",
                  path, told.size(), list));
}

bool is_damage(const StoreError& error) {
  return error.kind() == ErrorKind::corrupt || error.kind() == ErrorKind::not_a_database;
}

/// False if the checksum differs. Throws only if the bytes cannot be read.
bool agrees_with_checksum(const std::string& path) {
  try {
    verify_checksum_file(path);
    return true;
  } catch (const StoreError& error) {
    if (is_damage(error)) return false;
    throw;
  }
}

/// Throws if a backup cannot be read but is not known to be damaged, because it may be the newest good
/// backup.
void refuse_unread(const StoredBackup& backup) {
  if (backup.trouble.empty()) {
    if (!file_exists(backup.path + ".sha256") || !agrees_with_checksum(backup.path)) return;
  }
  throw StoreError(ErrorKind::io,
                   fmt::format("restore: nothing was changed: {}, which may be the newest backup, cannot "
                               "be read although it is not known to be damaged; check its disk. {}",
                               backup.path, backup.trouble));
}

/// Leaves out backups that another machine has made. Throws if no others are left, because then either the
/// machine was replaced, or these are backups of the original of a copy, whose data do not belong here.
void keep_own(const std::string& path, std::vector<StoredBackup>& backups) {
  const auto here = machine_identity();
  const auto all = backups;
  std::erase_if(backups, [&](const auto& backup) { return backup.is_of_other_machine(here); });
  if (all.empty() || !backups.empty()) return;
  throw StoreError(
      ErrorKind::other_machine,
      fmt::format(
          "restore: another machine made the backups of {} (the newest, of station {}: {}); nothing was "
          "changed; if this machine replaces that one, add --moved",
          path, all.back().station, all.back().path));
}

struct Candidates {
  std::vector<StoredBackup> backups;    ///< backups of the lost database, newest first
  std::vector<std::string> unreadable;  ///< unreadable files with this database's name
};

Candidates candidates_for(const std::string& path, const RestoreOptions& options) {
  const auto stem = std::filesystem::path(path).stem().string();
  const auto wanted = options.database_id.empty() ? id_of_lost(path) : options.database_id;
  Candidates candidates;
  std::set<std::string> ids;
  for (const auto& backup : stored_backups(canonical(options.directory))) {
    if (!backup.readable() && backup.stem == stem) refuse_unread(backup);
    if (!backup.readable() && backup.stem == stem) candidates.unreadable.push_back(backup.path);
    if (!backup.readable() || (wanted.empty() ? backup.stem != stem : backup.database_id != wanted)) continue;
    candidates.backups.push_back(backup);
    ids.insert(backup.database_id);
  }
  if (ids.size() > 1) refuse_ambiguous(path, candidates.backups);
  if (options.whose == Whose::found) keep_own(path, candidates.backups);
  std::reverse(candidates.backups.begin(), candidates.backups.end());
  return candidates;
}

/// Returns false for a damaged backup. If the backup cannot be read although its checksum is right, the disk
/// is at fault. Then it throws, so that no older backup is restored instead.
bool is_good(const StoredBackup& candidate) {
  if (!agrees_with_checksum(candidate.path)) return false;
  try {
    auto backup = open_reader(candidate.path);
    check_pages(backup);
    return true;
  } catch (const StoreError& error) {
    if (is_damage(error) && !file_exists(candidate.path + ".sha256")) return false;
    throw;
  }
}

/// Copies the backup to `path`.restored and checks the copy.
void prepare(const std::string& path, const StoredBackup& candidate, Whose whose) {
  auto good = open_reader(candidate.path);
  copy_to_file(good, path + ".restored", candidate.path, [&](Database& copy) {
    clear_backup_note(copy);
    if (whose == Whose::moved) move_station(copy, machine_identity());
  });
}

void count(Restoration& restoration, const std::string& path) {
  auto restored = open_reader(path);
  restoration.sessions = restored.integer("SELECT count(*) FROM session");
  restoration.trials = restored.integer("SELECT count(*) FROM trial");
  restoration.database_id = restored.text("SELECT value FROM meta WHERE key = 'database_id'");
  restoration.problems = file_problems(restored);
  for (const auto& session : verify_database(restored))
    if (!session.problems.empty()) restoration.changed.push_back(session.session_id);
}

}  // namespace

Restoration restore_backup(const std::string& name, const RestoreOptions& options) {
  const auto path = canonical(name);
  StationLock lock(path);
  require_lost(path);
  const auto candidates = candidates_for(path, options);
  Restoration restoration;
  restoration.rejected = candidates.unreadable;
  for (const auto& candidate : candidates.backups) {
    if (!is_good(candidate)) {
      restoration.rejected.push_back(candidate.path);
      continue;
    }
    prepare(path, candidate, options.whose);
    restoration.quarantined = replace_by_restored(path);
    restoration.from = candidate.path;
    count(restoration, path);
    lock.remember(restoration.database_id);
    return restoration;
  }
  throw StoreError(ErrorKind::missing,
                   fmt::format("restore: {} contains no intact backup of {} ({} backups failed their check); "
                               "nothing was changed",
                               options.directory, path, restoration.rejected.size()));
}

}  // namespace turnpoint::store

#include "station/store/backup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <set>
#include <utility>

#include "station/store/backup_folder.hpp"
#include "station/store/checksum.hpp"
#include "station/store/export_files.hpp"
#include "station/store/files.hpp"
#include "station/store/open.hpp"
#include "station/store/schema.hpp"
#include "station/store/station.hpp"
#include "station/store/verify.hpp"
#include "station/store/whole_file.hpp"
#include "station/system/clocks.hpp"
#include "station/system/write_file.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;

namespace {

std::string stem_of(const std::string& database) { return fs::path(database).stem().string(); }

void make_folder(const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
    throw StoreError(ErrorKind::read_only, fmt::format("backup to {}: {}; name a folder that can be written",
                                                       directory, error.message()));
}

std::string id_of(Database& database) {
  return database.text("SELECT value FROM meta WHERE key = 'database_id'");
}

std::vector<StoredBackup> backups_of(const std::string& directory, const std::string& database_id) {
  auto all = stored_backups(directory);
  const auto here = machine_identity();
  std::erase_if(all, [&](const auto& backup) {
    return backup.database_id != database_id || backup.is_of_other_machine(here);
  });
  return all;
}

std::string record_path(const std::string& database) { return database + ".last-backup"; }

/// Records the backup, so that the operator's page can show its age. If that fails, the backup is still
/// valid.
void record(BackupReport& report, const std::string& database, const std::string& database_id) {
  try {
    const auto name = record_path(database);
    system::write_file(name, fmt::format("{}\n{}\n{}\n", database_id, system::realtime_ns(), report.path));
    give_to_owner_of_folder(name);
  } catch (const std::exception& error) {
    report.unrecorded = error.what();
  }
}

/// Counts the sessions and trials in the finished backup. Throws if it contains fewer sessions than the
/// database.
void read_back(BackupReport& report, std::int64_t sessions) {
  Database copy(report.path, Database::Access::immutable);
  report.sessions = copy.integer("SELECT count(*) FROM session");
  report.trials = copy.integer("SELECT count(*) FROM trial");
  if (report.sessions < sessions)
    throw StoreError(ErrorKind::corrupt, fmt::format("backup {}: the file contains only {} of {} sessions; "
                                                     "older backups were not changed; check the disk",
                                                     report.path, report.sessions, sessions));
}

}  // namespace

void verify_checksum_file(const std::string& path) {
  if (!file_exists(path + ".sha256")) return;
  const auto expected = read_bytes(path + ".sha256").substr(0, 64);
  if (sha256_of_file(path) == expected) return;
  throw StoreError(ErrorKind::corrupt,
                   fmt::format("{} does not agree with {}.sha256: it was damaged or changed after it "
                               "was written; nothing was read from it; take another copy",
                               path, path));
}

std::optional<LastBackup> last_backup(const std::string& name) {
  const auto path = canonical(name);
  std::ifstream file(record_path(path));
  std::string id, time;
  LastBackup last;
  if (!std::getline(file, id) || !std::getline(file, time) || !std::getline(file, last.path)) return {};
  const auto known = remembered_database_id(path);
  const auto read = std::from_chars(time.data(), time.data() + time.size(), last.realtime_ns);
  if (read.ec != std::errc{} || (!known.empty() && id != known)) return {};
  return last;
}

std::vector<std::string> backups_in(const std::string& directory, const std::string& path) {
  auto database = open_reader(path);
  std::vector<std::string> paths;
  for (const auto& backup : backups_of(canonical(directory), id_of(database))) paths.push_back(backup.path);
  return paths;
}

BackupReport backup(const std::string& name, const BackupOptions& options) {
  const auto path = canonical(name), directory = canonical(options.directory);
  auto database = open_reader(path);
  check_pages(database);
  if (options.destination == Destination::disk) require_disk(directory, path);
  make_folder(directory);
  const BackupFolderLock lock(directory);
  remove_interrupted_backups(directory);
  const auto database_id = id_of(database);
  const auto older = backups_of(directory, database_id);
  BackupReport report;
  report.number = next_backup_number(directory);
  report.path = fmt::format("{}/{}-{:06}-{}.sqlite", directory, stem_of(path), report.number, time_stamp());
  const auto sessions = database.integer("SELECT count(*) FROM session");
  copy_to_file(database, report.path, path,
               [&](Database& copy) { write_backup_note(copy, stem_of(path), report.number); });
  read_back(report, sessions);
  report.bytes = file_size(report.path);
  report.sha256 = sha256_of_file(report.path);
  write_file(report.path + ".sha256",
             report.sha256 + "  " + fs::path(report.path).filename().string() + "\n");
  record(report, path, database_id);
  const auto kept_of_older = static_cast<std::size_t>(std::max(0, options.keep - 1));
  for (std::size_t i = 0; options.keep > 0 && i + kept_of_older < older.size(); ++i) {
    remove_backup(older[i].path);
    report.removed.push_back(older[i].path);
  }
  return report;
}

namespace {

std::int64_t sessions_in(Database& database) { return database.integer("SELECT count(*) FROM session"); }
std::int64_t trials_in(Database& database) { return database.integer("SELECT count(*) FROM trial"); }

/// Returns the newest backup of this database, even if it cannot be read, because a real restore would need
/// it too.
StoredBackup newest_backup(const std::string& directory, const std::string& path, const std::string& id) {
  const auto stem = std::filesystem::path(path).stem().string();
  StoredBackup newest;
  for (const auto& backup : stored_backups(directory))
    if (backup.readable() ? backup.database_id == id && !backup.is_of_other_machine(machine_identity())
                          : backup.stem == stem)
      newest = backup;
  if (newest.path.empty())
    throw StoreError(ErrorKind::missing,
                     fmt::format("drill: folder {} contains no backup of {}", directory, path));
  if (!newest.readable())
    throw StoreError(
        ErrorKind::corrupt,
        fmt::format("drill: the newest backup, {}, cannot be read: {}; check its disk and make "
                    "another backup",
                    newest.path, newest.trouble.empty() ? "the file is damaged" : newest.trouble));
  return newest;
}

/// The temporary file into which a drill (a trial restore) writes the backup. The destructor removes it.
class Restored {
 public:
  explicit Restored(const StoredBackup& backup) : path_(drill_file(backup.path)) {
    verify_checksum_file(backup.path);
    auto source = open_reader(backup.path);
    copy_to_file(source, path_, backup.path, clear_backup_note);
  }
  Restored(const Restored&) = delete;
  Restored& operator=(const Restored&) = delete;
  ~Restored() {
    if (path_.empty()) return;
    try {
      remove_database(path_);
    } catch (const StoreError&) {
      // If removing fails, the next backup or drill removes the file.
    }
  }
  const std::string& path() const { return path_; }
  /// Removes the file. Throws if that fails, so that the drill reports the remaining file.
  void remove() { remove_database(std::exchange(path_, "")); }

 private:
  std::string path_;
};

/// Compares a session of the backup with the database. Returns a description of the difference; "" if there
/// is none. It is no difference if the session has grown or was withdrawn after the backup.
std::string difference(Database& live, const VerifiedSession& session) {
  Statement withdrawn(live, "SELECT 1 FROM tombstone WHERE session_id = ?");
  Statement there(live, "SELECT 1 FROM session WHERE session_id = ?");
  if (withdrawn.bind(session.session_id).step()) return "";
  if (!there.bind(session.session_id).step()) return "the database no longer contains this session";
  if (session.links == 0 || holds_link(live, session.session_id, session.last_sha256)) return "";
  return "the database has different rows for this session";
}

}  // namespace

Drill drill_restore(const std::string& name, const std::string& folder) {
  const auto path = canonical(name), directory = canonical(folder);
  auto live = open_reader(path);
  const BackupFolderLock lock(directory);
  remove_interrupted_backups(directory);
  const auto backup =
      newest_backup(directory, path, live.text("SELECT value FROM meta WHERE key = 'database_id'"));
  Drill drill{backup.path,
              backup.number,
              1e-9 * static_cast<double>(system::realtime_ns()) - static_cast<double>(backup.made_realtime_s),
              0,
              0,
              sessions_in(live),
              trials_in(live),
              {}};
  Restored restored(backup);
  {
    auto database = open_reader(restored.path());
    drill.sessions = sessions_in(database);
    drill.trials = trials_in(database);
    drill.problems = file_problems(database);
    for (auto& session : verify_database(database)) {
      if (const auto differs = difference(live, session); !differs.empty())
        session.problems.push_back(differs);
      for (const auto& problem : session.problems)
        drill.problems.push_back(fmt::format("session {}: {}", session.session_id, problem));
    }
  }
  restored.remove();
  return drill;
}

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

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "station/store/backup.hpp"
#include "station/store/backup_folder.hpp"
#include "station/store/checksum.hpp"
#include "station/store/files.hpp"
#include "station/store/open.hpp"
#include "station/store/station.hpp"
#include "station/store/verify.hpp"
#include "station/store/whole_file.hpp"
#include "station/system/clocks.hpp"

namespace turnpoint::store {

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

}  // namespace turnpoint::store

#include "station/store/backup_folder.hpp"

#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <regex>

#include "station/store/files.hpp"
#include "station/store/schema.hpp"
#include "station/store/seal.hpp"
#include "station/store/station.hpp"

namespace turnpoint::store {

namespace {

/// Backups are named STEM-NUMBER-TIME.sqlite.
const std::regex kName(R"((.*?)-(\d{6,12})-(\d{8}T\d{6})\.\d{3}Z\.sqlite)");

/// Converts a UTC time such as "20240229T120000" to seconds since 1970. The year may be any of four digits.
std::int64_t seconds_of(const std::string& stamp) {
  std::tm utc{};
  return ::strptime(stamp.c_str(), "%Y%m%dT%H%M%S", &utc) == nullptr
             ? 0
             : static_cast<std::int64_t>(::timegm(&utc));
}

std::string meta(Database& database, const std::string& key) {
  Statement row(database, "SELECT value FROM meta WHERE key = ?");
  row.bind(key);
  return row.step() ? row.text(0) : "";
}

StoredBackup read_backup(const std::string& path, const std::smatch& name) {
  StoredBackup backup;
  backup.path = path;
  backup.stem = name[1];
  backup.number = std::stoll(name[2]);
  backup.made_realtime_s = seconds_of(name[3]);
  try {
    looked_at(path, [&] {
      Database database(path, Database::Access::immutable);
      require_schema(database);
      if (const auto noted = meta(database, "backup_of"); !noted.empty()) backup.stem = noted;
      if (const auto noted = meta(database, "backup_number"); !noted.empty())
        backup.number = std::stoll(noted);
      backup.station = database.text("SELECT station_id FROM session LIMIT 1");
      backup.machine = meta(database, "backup_machine");
      backup.database_id = meta(database, "database_id");
    });
  } catch (const StoreError& error) {
    if (error.kind() == ErrorKind::other_schema)
      backup.stem.clear();  // nobody can restore it with this program
    else if (error.kind() != ErrorKind::corrupt && error.kind() != ErrorKind::not_a_database)
      backup.trouble = error.what();
    backup.database_id.clear();
  }
  return backup;
}

}  // namespace

std::vector<StoredBackup> stored_backups(const std::string& folder) {
  std::vector<StoredBackup> backups;
  for (const auto& name : list_folder(folder)) {
    std::smatch parts;
    if (std::regex_match(name, parts, kName)) backups.push_back(read_backup(folder + "/" + name, parts));
  }
  std::stable_sort(backups.begin(), backups.end(),
                   [](const auto& a, const auto& b) { return a.number < b.number; });
  return backups;
}

std::int64_t next_backup_number(const std::string& folder) {
  const auto all = stored_backups(folder);
  return all.empty() ? 1 : all.back().number + 1;
}

void write_backup_note(Database& copy, const std::string& stem, std::int64_t number) {
  SealedTransaction transaction(copy);
  Statement note(copy, "INSERT OR REPLACE INTO meta VALUES (?, ?)");
  note.bind("backup_of", stem).run();
  note.bind("backup_number", std::to_string(number)).run();
  note.bind("backup_machine", machine_identity()).run();
  transaction.commit();
}

void clear_backup_note(Database& copy) {
  SealedTransaction transaction(copy);
  copy.execute("DELETE FROM meta WHERE key IN ('backup_of', 'backup_number', 'backup_machine')");
  transaction.commit();
}

void remove_backup(const std::string& path) {
  remove_file(path + ".sha256");
  remove_database(path);
}

BackupFolderLock::BackupFolderLock(const std::string& folder)
    : lock_(open_lock(folder + "/turnpoint-backups.lock")) {
  while (::flock(lock_.get(), LOCK_EX) != 0 && errno == EINTR) {
  }
}

std::string drill_file(const std::string& backup) { return backup + ".drill"; }

namespace {

/// Returns the file system that holds a folder. Appending "/." to the path makes an automounter mount the
/// disk first.
dev_t file_system_of(const std::string& folder) {
  struct stat status {};
  if (::stat((folder + "/.").c_str(), &status) == 0) return status.st_dev;
  fail_system(kind_of_errno(errno), folder, errno, "check the folder and its disk");
}

bool is_mount_point(const std::string& folder) {
  return file_exists(folder) && file_system_of(folder) != file_system_of(folder_of(folder));
}

}  // namespace

void require_disk(const std::string& folder, const std::string& database) {
  const auto above = folder_of(folder);
  const auto refuse = [&](const std::string& why) {
    throw StoreError(ErrorKind::no_disk,
                     fmt::format("backup to {}: {}; nothing was written; mount the backup disk, or write "
                                 "--to FOLDER if the backups belong in an ordinary folder",
                                 folder, why));
  };
  const bool mounted = is_mount_point(folder) || is_mount_point(above);
  if (!mounted) refuse(fmt::format("no disk is mounted at this folder or at {}", above));
  if (file_system_of(file_exists(folder) ? folder : above) == file_system_of(folder_of(database)))
    refuse("this folder is on the same disk as the database");
}

std::vector<std::string> remove_interrupted_backups(const std::string& folder) {
  std::vector<std::string> removed;
  static const std::regex half_made(
      R"(.*-\d{8}T\d{6}\.\d{3}Z\.sqlite(\.sha256)?(\.drill|\.drill\.new|\.new)(-wal|-shm|-journal)?)");
  for (const auto& name : list_folder(folder)) {
    if (!std::regex_match(name, half_made)) continue;
    remove_file(folder + "/" + name);
    removed.push_back(folder + "/" + name);
  }
  return removed;
}

}  // namespace turnpoint::store

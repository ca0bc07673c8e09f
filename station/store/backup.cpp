#include "station/store/backup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>

#include "station/store/backup_folder.hpp"
#include "station/store/export_files.hpp"
#include "station/store/files.hpp"
#include "station/store/open.hpp"
#include "station/store/station.hpp"
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

}  // namespace turnpoint::store

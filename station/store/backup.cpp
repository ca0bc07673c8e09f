#include "station/store/backup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "station/store/backup_folder.hpp"
#include "station/store/export_files.hpp"
#include "station/store/files.hpp"
#include "station/store/open.hpp"
#include "station/store/whole_file.hpp"
#include "station/text/number.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;

namespace {

std::string stem_of(const std::string& database) { return fs::path(database).stem().string(); }

void make_folder(const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
    throw StoreError(Fault::read_only, fmt::format("backup to {}: {}; name a folder that can be written",
                                                   directory, error.message()));
}

std::string id_of(Database& database) {
  return database.text("SELECT value FROM meta WHERE key = 'database_id'");
}

std::vector<StoredBackup> backups_of(const std::string& directory, const std::string& database_id) {
  auto all = stored_backups(directory);
  std::erase_if(all, [&](const auto& backup) { return backup.database_id != database_id; });
  return all;
}

/// What is in the file that was made: never what was meant to be in it.
void read_back(BackupReport& report, std::int64_t sessions) {
  Database copy(report.path, Database::Access::immutable);
  report.sessions = copy.integer("SELECT count(*) FROM session");
  report.trials = copy.integer("SELECT count(*) FROM trial");
  if (report.sessions < sessions)
    throw StoreError(
        Fault::corrupt,
        fmt::format("backup {}: it holds {} sessions of {}; older backups are untouched; check the disk",
                    report.path, report.sessions, sessions));
}

}  // namespace

void verify_checksum_file(const std::string& path) {
  if (!file_exists(path + ".sha256")) return;
  const auto expected = read_bytes(path + ".sha256").substr(0, 64);
  if (text::sha256(read_bytes(path)) == expected) return;
  throw StoreError(Fault::corrupt,
                   fmt::format("{} does not agree with {}.sha256: it was damaged or changed after it "
                               "was written; nothing was read from it; take another copy",
                               path, path));
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
  make_folder(directory);
  const BackupFolderLock lock(directory);
  remove_interrupted_backups(directory);
  const auto older = backups_of(directory, id_of(database));
  BackupReport report;
  report.number = next_backup_number(directory);
  report.path = fmt::format("{}/{}-{:06}-{}.sqlite", directory, stem_of(path), report.number, time_stamp());
  const auto sessions = database.integer("SELECT count(*) FROM session");
  copy_to_file(database, report.path, path,
               [&](Database& copy) { write_backup_note(copy, stem_of(path), report.number); });
  read_back(report, sessions);
  const auto bytes = read_bytes(report.path);
  report.bytes = bytes.size();
  report.sha256 = text::sha256(bytes);
  write_file(report.path + ".sha256",
             report.sha256 + "  " + fs::path(report.path).filename().string() + "\n");
  const auto kept_of_older = static_cast<std::size_t>(std::max(0, options.keep - 1));
  for (std::size_t i = 0; options.keep > 0 && i + kept_of_older < older.size(); ++i) {
    remove_backup(older[i].path);
    report.removed.push_back(older[i].path);
  }
  return report;
}

}  // namespace turnpoint::store

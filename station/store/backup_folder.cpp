#include "station/store/backup_folder.hpp"

#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <regex>

#include "station/store/files.hpp"

namespace turnpoint::store {

namespace {

/// STEM-TIME.sqlite in older releases, STEM-NUMBER-TIME.sqlite since.
const std::regex kName(R"((.*?)(?:-(\d{6,12}))?-\d{8}T\d{6}\.\d{3}Z\.sqlite)");

std::string meta(Database& database, const std::string& key) {
  Statement row(database, "SELECT value FROM meta WHERE key = ?");
  row.bind(key);
  return row.step() ? row.text(0) : "";
}

/// `number` as the name has it, "" where it has none.
StoredBackup read_backup(const std::string& path, const std::string& stem, const std::string& number) {
  StoredBackup backup;
  backup.path = path;
  backup.stem = stem;
  if (!number.empty()) backup.number = std::stoll(number);
  try {
    Database database(path, Database::Access::immutable);
    if (const auto noted = meta(database, "backup_of"); !noted.empty()) backup.stem = noted;
    if (const auto noted = meta(database, "backup_number"); !noted.empty()) backup.number = std::stoll(noted);
    backup.station = database.text("SELECT station_id FROM session LIMIT 1");
    backup.database_id = meta(database, "database_id");
  } catch (const StoreError& error) {
    const bool damaged = error.fault() == Fault::corrupt || error.fault() == Fault::not_a_database;
    if (!damaged) backup.trouble = error.what();
    backup.database_id.clear();
  }
  return backup;
}

}  // namespace

std::vector<StoredBackup> stored_backups(const std::string& folder) {
  std::vector<StoredBackup> backups;
  for (const auto& name : list_folder(folder)) {
    std::smatch parts;
    if (std::regex_match(name, parts, kName))
      backups.push_back(read_backup(folder + "/" + name, parts[1], parts[2]));
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
  Transaction transaction(copy);
  Statement note(copy, "INSERT OR REPLACE INTO meta VALUES (?, ?)");
  note.bind("backup_of", stem).run();
  note.bind("backup_number", std::to_string(number)).run();
  transaction.commit();
}

void clear_backup_note(Database& copy) {
  copy.execute("DELETE FROM meta WHERE key IN ('backup_of', 'backup_number')");
}

void remove_backup(const std::string& path) {
  remove_file(path + ".sha256");
  remove_database(path);
}

BackupFolderLock::BackupFolderLock(const std::string& folder)
    : descriptor_(open_lock(folder + "/turnpoint-backups.lock")) {
  while (::flock(descriptor_, LOCK_EX) != 0 && errno == EINTR) {
  }
}

BackupFolderLock::~BackupFolderLock() { ::close(descriptor_); }

std::vector<std::string> remove_interrupted_backups(const std::string& folder) {
  std::vector<std::string> removed;
  static const std::regex half_made(R"(.*-\d{8}T\d{6}\.\d{3}Z\.sqlite(\.sha256)?\.new(-wal|-shm|-journal)?)");
  for (const auto& name : list_folder(folder)) {
    if (!std::regex_match(name, half_made)) continue;
    remove_file(folder + "/" + name);
    removed.push_back(folder + "/" + name);
  }
  return removed;
}

}  // namespace turnpoint::store

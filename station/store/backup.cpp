#include "station/store/backup.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <optional>

#include "station/store/export_files.hpp"
#include "station/store/files.hpp"
#include "station/store/identity.hpp"
#include "station/store/open.hpp"
#include "station/store/sqlite.hpp"
#include "station/text/number.hpp"
#include "station/text/toml.hpp"

namespace turnpoint::store {

namespace fs = std::filesystem;

namespace {

/// UTC with milliseconds: names sort by time.
std::string stamp() {
  const auto ns = realtime_ns();
  const std::time_t seconds = ns / 1'000'000'000;
  return fmt::format("{:%Y%m%dT%H%M%S}.{:03}Z", fmt::gmtime(seconds), ns / 1'000'000 % 1000);
}

std::string stem_of(const std::string& database) { return fs::path(database).stem().string(); }

struct Counts {
  std::int64_t sessions = 0, trials = 0;
  bool operator==(const Counts&) const = default;
};

Counts counts_of(Database& database) {
  return {database.integer("SELECT count(*) FROM session"), database.integer("SELECT count(*) FROM trial")};
}

void make_folder(const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error)
    throw StoreError(Fault::read_only, fmt::format("backup to {}: {}; name a folder that can be written",
                                                   directory, error.message()));
}

/// The fault of a database that cannot be used as it is, or none.
std::optional<StoreError> trouble_with(const std::string& database) {
  try {
    open_reader(database);
    return std::nullopt;
  } catch (const StoreError& error) {
    return error;
  }
}

/// Moves a file and its log aside under a name that says so.
std::string quarantine(const std::string& database) {
  if (!fs::exists(database)) return "";
  const auto aside = database + ".damaged-" + stamp();
  for (const auto* suffix : {"", "-wal", "-shm", "-journal"})
    if (fs::exists(database + suffix)) fs::rename(database + suffix, aside + suffix);
  return aside;
}

}  // namespace

void verify_checksum_file(const std::string& path) {
  if (!fs::exists(path + ".sha256")) return;
  const auto expected = text::read_file(path + ".sha256").substr(0, 64);
  if (text::sha256(text::read_file(path)) == expected) return;
  throw StoreError(Fault::corrupt,
                   fmt::format("{} does not agree with {}.sha256: it was damaged or changed after it "
                               "was written; nothing was read from it; take another copy",
                               path, path));
}

std::vector<std::string> backups_in(const std::string& directory, const std::string& database) {
  std::vector<std::string> found;
  std::error_code ignored;
  const auto prefix = stem_of(database) + "-";
  for (const auto& entry : fs::directory_iterator(directory, ignored)) {
    const auto name = entry.path().filename().string();
    if (name.rfind(prefix, 0) == 0 && name.ends_with("Z.sqlite")) found.push_back(entry.path().string());
  }
  std::sort(found.begin(), found.end());
  return found;
}

BackupReport backup(const std::string& path, const BackupOptions& options) {
  auto database = open_reader(path);
  make_folder(options.directory);
  BackupReport report;
  report.path = (fs::path(options.directory) / fmt::format("{}-{}.sqlite", stem_of(path), stamp())).string();
  copy_to_file(database, report.path, path);
  {
    Database copy(report.path, Database::Access::immutable);
    const auto whole = copy.text("PRAGMA integrity_check(1)");
    if (whole != "ok") {
      fs::remove(report.path);
      throw StoreError(Fault::corrupt,
                       fmt::format("backup {}: integrity_check: {}; it was removed, older backups "
                                   "are untouched; check the disk",
                                   report.path, whole));
    }
    const auto counts = counts_of(copy);
    report.sessions = counts.sessions;
    report.trials = counts.trials;
  }
  report.bytes = fs::file_size(report.path);
  report.sha256 = text::sha256(text::read_file(report.path));
  write_file(report.path + ".sha256",
             report.sha256 + "  " + fs::path(report.path).filename().string() + "\n");
  auto all = backups_in(options.directory, path);
  for (std::size_t i = 0; options.keep > 0 && i + static_cast<std::size_t>(options.keep) < all.size(); ++i) {
    fs::remove(all[i]);
    fs::remove(all[i] + ".sha256");
    report.removed.push_back(all[i]);
  }
  return report;
}

Restoration restore_backup(const std::string& path, const std::string& directory) {
  const StationLock lock(canonical(path));
  const auto trouble = trouble_with(path);
  if (!trouble)
    throw StoreError(Fault::refused,
                     fmt::format("restore: database {} is good; nothing was changed; to go back to a "
                                 "backup all the same, move it away first",
                                 path));
  const bool replaceable = trouble->fault() == Fault::corrupt || trouble->fault() == Fault::not_a_database ||
                           trouble->fault() == Fault::missing;
  if (!replaceable) throw *trouble;
  Restoration restoration;
  auto all = backups_in(directory, path);
  std::reverse(all.begin(), all.end());
  for (const auto& candidate : all) {
    try {
      verify_checksum_file(candidate);
      auto good = open_reader(candidate);
      const auto counts = counts_of(good);
      copy_to_file(good, path + ".restored", candidate);
      restoration.quarantined = quarantine(path);
      fs::rename(path + ".restored", path);
      sync_path(fs::absolute(path).parent_path().string());
      restoration.from = candidate;
      restoration.sessions = counts.sessions;
      restoration.trials = counts.trials;
      return restoration;
    } catch (const StoreError& error) {
      if (error.fault() == Fault::disk_full || error.fault() == Fault::read_only) throw;
      restoration.rejected.push_back(candidate);
    }
  }
  throw StoreError(Fault::missing,
                   fmt::format("restore: {} holds no good backup of {} ({} failed their check); "
                               "nothing was changed",
                               directory, path, restoration.rejected.size()));
}

}  // namespace turnpoint::store

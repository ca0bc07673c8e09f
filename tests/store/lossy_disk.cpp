#include "tests/store/lossy_disk.hpp"

#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace {

constexpr std::size_t kSector = 512;

struct Change {
  std::size_t offset = 0;
  std::string bytes;
  bool truncates = false;
};

/// The durable content of a file, and the writes that so far are only in the disk's cache.
struct Platter {
  std::string durable;
  std::vector<Change> waiting;
};

sqlite3_vfs* real = nullptr;
sqlite3_vfs shim;
std::map<const sqlite3_io_methods*, sqlite3_io_methods> methods;
std::map<std::string, Platter> platters;
std::map<sqlite3_file*, std::string> names;
std::function<void()> hook;
LossyDisk::Syncs mode;
// SQLite's own methods of some file. Those for writing, truncating, syncing and closing are the same for all
// files.
const sqlite3_io_methods* any_real = nullptr;

void apply(std::string& bytes, const Change& change) {
  if (change.truncates) return bytes.resize(change.offset);
  if (bytes.size() < change.offset + change.bytes.size()) bytes.resize(change.offset + change.bytes.size());
  bytes.replace(change.offset, change.bytes.size(), change.bytes);
}

void operation() {
  if (hook) hook();
}

int write(sqlite3_file* file, const void* data, int size, sqlite3_int64 offset) {
  operation();
  platters[names[file]].waiting.push_back({static_cast<std::size_t>(offset),
                                           {static_cast<const char*>(data), static_cast<std::size_t>(size)},
                                           false});
  return any_real->xWrite(file, data, size, offset);
}

int truncate(sqlite3_file* file, sqlite3_int64 size) {
  operation();
  platters[names[file]].waiting.push_back({static_cast<std::size_t>(size), "", true});
  return any_real->xTruncate(file, size);
}

int sync(sqlite3_file* file, int flags) {
  operation();
  auto& platter = platters[names[file]];
  if (mode == LossyDisk::Syncs::kept) {
    for (const auto& change : platter.waiting) apply(platter.durable, change);
    platter.waiting.clear();
  }
  return any_real->xSync(file, flags);
}

int close(sqlite3_file* file) {
  names.erase(file);
  return any_real->xClose(file);
}

std::string bytes_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream all;
  all << stream.rdbuf();
  return all.str();
}

int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  const int code = real->xOpen(real, name, file, flags, out_flags);
  if (code != SQLITE_OK || file->pMethods == nullptr || name == nullptr) return code;
  any_real = file->pMethods;
  auto& own = methods[file->pMethods];
  own = *file->pMethods;
  own.xWrite = write;
  own.xTruncate = truncate;
  own.xSync = sync;
  own.xClose = close;
  file->pMethods = &own;
  names[file] = name;
  if (platters.count(name) == 0) platters[name].durable = bytes_of(name);
  return code;
}

int remove(sqlite3_vfs*, const char* name, int sync_folder) {
  platters.erase(name);
  return real->xDelete(real, name, sync_folder);
}

}  // namespace

LossyDisk::LossyDisk(Syncs syncs) {
  mode = syncs;
  platters.clear();
  names.clear();
  real = sqlite3_vfs_find(nullptr);
  shim = *real;
  shim.zName = "lossy-disk";
  shim.xOpen = open;
  shim.xDelete = remove;
  if (sqlite3_vfs_register(&shim, 1) != SQLITE_OK) throw std::runtime_error("no file system for SQLite");
}

LossyDisk::~LossyDisk() {
  hook = nullptr;
  sqlite3_vfs_unregister(&shim);
}

void LossyDisk::at_each_operation(std::function<void()> call) { hook = std::move(call); }

void LossyDisk::cut(const std::string& database, const std::string& into, std::uint64_t seed) const {
  std::mt19937_64 random(seed);
  const auto survival =
      // the share of unsynced writes that survive this cut, from none to all
      std::uniform_real_distribution<>(0, 1)(random);
  const auto survives = [&] { return std::uniform_real_distribution<>(0, 1)(random) < survival; };
  for (const auto* suffix : {"", "-wal"}) {
    const auto found = platters.find(database + suffix);
    if (found == platters.end()) continue;
    auto bytes = found->second.durable;
    for (const auto& change : found->second.waiting) {
      if (change.truncates && survives()) apply(bytes, change);
      for (std::size_t at = 0; at < change.bytes.size(); at += kSector)
        if (survives()) apply(bytes, {change.offset + at, change.bytes.substr(at, kSector), false});
    }
    const auto name = std::filesystem::path(database + suffix).filename().string();
    std::ofstream(into + "/" + name, std::ios::binary) << bytes;
  }
}

void LossyDisk::forget(const std::string& database) {
  for (const auto* suffix : {"", "-wal"}) platters.erase(database + suffix);
}

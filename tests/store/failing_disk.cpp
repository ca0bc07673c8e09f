#include "tests/store/failing_disk.hpp"

#include <sqlite3.h>

#include <atomic>
#include <limits>
#include <map>
#include <stdexcept>

namespace {

std::atomic<std::int64_t> left = std::numeric_limits<std::int64_t>::max();
sqlite3_vfs* real = nullptr;
sqlite3_vfs shim;
int (*real_write)(sqlite3_file*, const void*, int, sqlite3_int64) = nullptr;
/// Copies of SQLite's method tables, in which write() replaces SQLite's own function. SQLite has different
/// tables for databases and journals.
std::map<const sqlite3_io_methods*, sqlite3_io_methods> methods;

int write(sqlite3_file* file, const void* data, int size, sqlite3_int64 offset) {
  if (size > left) return SQLITE_FULL;
  left -= size;
  return real_write(file, data, size, offset);
}

/// Opens a file with SQLite's own methods, but replaces the method that writes.
int open(sqlite3_vfs*, const char* name, sqlite3_file* file, int flags, int* out_flags) {
  const int code = real->xOpen(real, name, file, flags, out_flags);
  if (code != SQLITE_OK || file->pMethods == nullptr) return code;
  real_write = file->pMethods->xWrite;
  auto& own = methods[file->pMethods];
  own = *file->pMethods;
  own.xWrite = write;
  file->pMethods = &own;
  return code;
}

}  // namespace

FailingDisk::FailingDisk() {
  real = sqlite3_vfs_find(nullptr);
  shim = *real;
  shim.zName = "failing-disk";
  shim.xOpen = open;
  if (sqlite3_vfs_register(&shim, 1) != SQLITE_OK) throw std::runtime_error("cannot register the test VFS");
}

FailingDisk::~FailingDisk() {
  sqlite3_vfs_unregister(&shim);
  space_again();
}

void FailingDisk::bytes_left(std::int64_t bytes) { left = bytes; }
void FailingDisk::space_again() { left = std::numeric_limits<std::int64_t>::max(); }

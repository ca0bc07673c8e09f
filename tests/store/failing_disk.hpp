#pragma once
#include <cstdint>

/// Makes SQLite write to a disk that fills up. This is a shim over the real file system and the default for
/// connections opened during its lifetime. Use one at a time; bytes_left() and space_again() may be called
/// from any thread.
class FailingDisk {
 public:
  FailingDisk();
  FailingDisk(const FailingDisk&) = delete;
  FailingDisk& operator=(const FailingDisk&) = delete;
  ~FailingDisk();

  void bytes_left(std::int64_t bytes);  ///< writes beyond this fail with SQLITE_FULL
  void space_again();
};

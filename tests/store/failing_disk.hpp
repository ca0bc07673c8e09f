#pragma once
#include <cstdint>

/// Makes SQLite write to a simulated disk that fills up. While an object exists, new connections use this
/// disk by default; everything except writing goes to the real file system. Only one object may exist at a
/// time. bytes_left() and space_again() may be called from any thread.
class FailingDisk {
 public:
  FailingDisk();
  FailingDisk(const FailingDisk&) = delete;
  FailingDisk& operator=(const FailingDisk&) = delete;
  ~FailingDisk();

  void bytes_left(std::int64_t bytes);  ///< after this many more bytes, writes fail with SQLITE_FULL
  void space_again();
};

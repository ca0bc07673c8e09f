#pragma once
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

/// Writes marks that appear in the record of all writes to a disk. A mark is a sector behind the file system,
/// written past all caches but not flushed. A mark in the record proves that the disk had accepted everything
/// recorded before that.
class DiskMarker {
 public:
  /// Opens `device` as a block device. Exits with a message if that fails.
  explicit DiskMarker(const char* device) : fd_(::open(device, O_WRONLY | O_DIRECT | O_CLOEXEC)) {
    if (fd_ < 0 || ::posix_memalign(&sector_, 4096, size) != 0) std::perror(device), std::exit(1);
  }
  DiskMarker(const DiskMarker&) = delete;
  DiskMarker& operator=(const DiskMarker&) = delete;
  ~DiskMarker() { ::close(fd_), std::free(sector_); }

  void mark(const std::string& text) {
    std::memset(sector_, 0, size);
    std::memcpy(sector_, text.data(), std::min<std::size_t>(text.size(), size - 1));
    if (::pwrite(fd_, sector_, size, offset) != static_cast<ssize_t>(size)) std::perror("mark"), std::exit(1);
  }

 private:
  static constexpr std::size_t size = 512;
  static constexpr off_t offset =
      31 << 20;  ///< power_cuts.py looks for marks at this offset, which is behind the end of the file system
  int fd_;
  void* sector_ = nullptr;
};

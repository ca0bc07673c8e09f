#pragma once
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

/// Puts marks into the record of a disk's writes: a sector behind the file system, written past all caches
/// but not flushed. A mark at some place of the record says that the disk had taken all that went before.
class DiskMarker {
 public:
  /// `device` as a block device; exits with a message where it cannot be opened.
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
      31 << 20;  ///< where power_cuts.py looks for it: the file system ends before
  int fd_;
  void* sector_ = nullptr;
};

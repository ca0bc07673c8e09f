#pragma once
#include <sys/mount.h>

#include <fstream>
#include <string>

#include "tests/support/temporary_folder.hpp"

/// A small file system in memory, which a test can fill. Needs the right to mount; `mounted` says whether
/// there is one.
struct SmallDisk {
  explicit SmallDisk(int size_MiB)
      : mounted(::mount("small", folder.path.c_str(), "tmpfs", 0,
                        ("size=" + std::to_string(size_MiB) + "m").c_str()) == 0) {}
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;
  ~SmallDisk() {
    if (mounted) ::umount2(folder.path.c_str(), MNT_DETACH);
  }
  /// Makes the disk accept no writing any more.
  bool protect() {
    return ::mount("small", folder.path.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr) == 0;
  }
  /// Writes a file until nothing more fits.
  static void fill(const std::string& path) {
    std::ofstream file(path, std::ios::binary);
    const std::string kilobyte(1024, 'x');
    while (file.write(kilobyte.data(), 1024).flush()) continue;
  }
  std::string operator/(const std::string& name) const { return folder / name; }
  TemporaryFolder folder;
  bool mounted = false;
};

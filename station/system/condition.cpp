#include "station/system/condition.hpp"

#include <fmt/format.h>
#include <sys/statfs.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>

namespace turnpoint::system {

namespace {

/// The name of a file system by its number in statfs(2).
std::string file_system_of(const std::string& folder) {
  struct statfs state {};
  if (::statfs(folder.c_str(), &state) != 0) return "";
  const auto number = static_cast<std::uint32_t>(state.f_type);
  static const std::map<std::uint32_t, const char*> names{
      {0xef53, "ext4"},      {0x9123683e, "btrfs"}, {0x58465342, "xfs"},      {0xf2f52010, "f2fs"},
      {0x01021994, "tmpfs"}, {0x858458f6, "ramfs"}, {0x794c7630, "overlay"},  {0x6969, "nfs"},
      {0xff534d42, "cifs"},  {0xfe534d42, "cifs"},  {0x517b, "cifs"},         {0x65735546, "fuse"},
      {0x01021997, "9p"},    {0x4d44, "vfat"},      {0x2011bab0, "exfat"},    {0x5346544e, "ntfs"},
      {0x7366746e, "ntfs"},  {0x00c36400, "ceph"},  {0x0bd00bd0, "lustre"},   {0x73757245, "coda"},
      {0x01161970, "gfs2"},  {0x7461636f, "ocfs2"}, {0x47504653, "gpfs"},     {0x19830326, "beegfs"},
      {0x6b414653, "afs"},   {0x2fc12fc1, "zfs"},   {0xca451a4e, "bcachefs"}, {0x3434, "nilfs"},
      {0x24051905, "ubifs"}, {0x72b6, "jffs2"},     {0x52654973, "reiserfs"}, {0x3153464a, "jfs"},
      {0xf15f, "ecryptfs"},  {0x482b, "hfsplus"},   {0x9660, "iso9660"},      {0x73717368, "squashfs"},
      {0xe0f5e1e2, "erofs"}, {0x5346414f, "afs"},   {0x786f4256, "vboxsf"}};
  const auto found = names.find(number);
  return found == names.end() ? fmt::format("{:#x}", number) : found->second;
}

}  // namespace

Disk read_disk(const std::string& folder) {
  std::filesystem::path existing = std::filesystem::absolute(folder);
  std::error_code ignored;
  while (!std::filesystem::exists(existing, ignored) && existing.has_relative_path())
    existing = existing.parent_path();
  Disk disk{existing.string(), 0, false, "", file_system_of(existing.string())};
  struct statvfs state {};
  if (::statvfs(existing.c_str(), &state) != 0) {
    disk.error = std::strerror(errno);
    return disk;
  }
  disk.free_MiB = static_cast<double>(state.f_bavail) * static_cast<double>(state.f_frsize) / 1048576;
  disk.writable = ::access(existing.c_str(), W_OK) == 0;
  return disk;
}

WallClock read_wall_clock() {
  WallClock clock{"unknown", false, false};
  std::ifstream("/sys/devices/system/clocksource/clocksource0/current_clocksource") >> clock.source;
  timex state{};
  clock.steered = ::adjtimex(&state) != -1 && !(state.status & STA_UNSYNC);
  clock.plausible = std::time(nullptr) > 1'700'000'000;
  return clock;
}

std::optional<double> hottest_C(const std::string& folder) {
  std::optional<double> hottest;
  std::error_code none;
  for (const auto& chip : std::filesystem::directory_iterator(folder, none))
    for (const auto& entry : std::filesystem::directory_iterator(chip.path(), none)) {
      const auto name = entry.path().filename().string();
      if (!name.starts_with("temp") || !name.ends_with("_input")) continue;
      std::ifstream file(entry.path());
      double thousandths = 0;
      // skip impossible temperatures, which a sensor reports if it is not connected
      if (!(file >> thousandths) || thousandths < -50'000 || thousandths > 150'000) continue;
      hottest = std::max(hottest.value_or(-1e9), 1e-3 * thousandths);
    }
  return hottest;
}

}  // namespace turnpoint::system

#include "station/system/condition.hpp"

#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>

namespace turnpoint::system {

Disk read_disk(const std::string& folder) {
  std::filesystem::path existing = std::filesystem::absolute(folder);
  std::error_code ignored;
  while (!std::filesystem::exists(existing, ignored) && existing.has_relative_path())
    existing = existing.parent_path();
  Disk disk{existing.string(), 0, false, ""};
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

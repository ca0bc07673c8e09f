#pragma once
#include <optional>
#include <string>

namespace turnpoint::system {

/// The disk that holds a folder.
struct Disk {
  std::string folder;   ///< the folder, or the nearest one above it that exists
  double free_MiB = 0;  ///< space in which this user may still write
  bool writable = false;
  std::string error;  ///< why the disk cannot be examined; "" if it can
  /// such as "ext4"; a number in hexadecimal if it is not among those that this program knows
  std::string file_system;
};
Disk read_disk(const std::string& folder);

/// What the kernel says about the wall clock.
struct WallClock {
  std::string source;      ///< the kernel's clock source, such as "tsc"
  bool steered = false;    ///< a time service keeps the clock right
  bool plausible = false;  ///< false if the date is before November 2023
};
WallClock read_wall_clock();

/// The highest temperature (degrees Celsius) of the machine's sensors; empty if it has none. `folder` is
/// where the kernel lists its sensors.
std::optional<double> hottest_C(const std::string& folder = "/sys/class/hwmon");

}  // namespace turnpoint::system

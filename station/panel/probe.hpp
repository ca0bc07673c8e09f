#pragma once
#include <optional>
#include <string>
#include <vector>

namespace turnpoint::panel {

/// One thing that was looked at, for `doctor`.
struct Check {
  enum class Status { ok, warning, failed };
  std::string name;
  Status status = Status::ok;
  std::string what;  ///< what was found
  std::string mend;  ///< how to mend it; "" where nothing is wrong
};

/// Each line of a device's URI (`gpio:...`): on a chip, not in use. One check a line; for `sim:` one that
/// says so.
std::vector<Check> check_lines(const std::string& device, const std::string& uri);

/// The touch sensor or panel of an `evdev:NAME` URI: there, readable, with monotonic stamps.
Check check_touch(const std::string& device, const std::string& uri);

}  // namespace turnpoint::panel

#pragma once
#include <optional>
#include <string>
#include <vector>

namespace turnpoint::lines {

/// One thing that was looked at, for `doctor`.
struct Finding {
  enum class Status { ok, warning, failed };
  std::string name;
  Status status = Status::ok;
  std::string what;  ///< what was found
  std::string mend;  ///< how to mend it; "" where nothing is wrong
};

/// Each line of a device's URI (`gpio:...`): on a chip, not in use. One check a line; for `sim:` one that
/// says so.
std::vector<Finding> check_lines(const std::string& device, const std::string& uri);

/// The touch sensor or panel of an `evdev:NAME` URI: there, readable, with monotonic stamps.
Finding check_touch(const std::string& device, const std::string& uri);

/// What opening the machine's input devices gave.
struct InputDevices {
  int opened = 0;
  std::vector<std::string> refused;  ///< "/dev/input/event3: Operation not permitted"
};

/// Opens each input device in `folder` for reading and writing, and closes it. That is how libinput opens
/// them, with which eglfs and linuxfb read touches, mice and keyboards: where it is refused, their touches
/// never arrive, although the device can be read.
InputDevices try_input_devices(const std::string& folder = "/dev/input");

}  // namespace turnpoint::lines

#pragma once
#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "station/core/texts.hpp"

namespace turnpoint::io {

/// The result of one check by `doctor`.
struct Finding {
  enum class Status { ok, warning, failed };
  core::Phrase name;
  Status status = Status::ok;
  core::Phrase what;
  core::Phrase mend;  ///< how to fix it; without words if nothing is wrong
};

/// What the system or a driver said when a check failed, for a finding. It stays as it is in every language.
core::Phrase reported(const std::exception& error);

/// Checks that each line in a device's URI (`gpio:...`) is on a chip and not in use. Returns one finding per
/// line; for `sim:`, one finding that the device is simulated.
std::vector<Finding> check_lines(const core::Phrase& device, const std::string& uri);

/// Checks that the touch sensor or panel of an `evdev:NAME` URI exists, is readable and has monotonic time
/// stamps.
Finding check_touch(const core::Phrase& device, const std::string& uri);

/// The result of trying to open the machine's input devices.
struct InputDevices {
  int opened = 0;
  /// devices that could not be opened, such as "/dev/input/event3: Operation not permitted"
  std::vector<std::string> refused;
};

/// Opens each input device in `folder` for reading and writing, and closes it. libinput, through which eglfs
/// and linuxfb get touches, mice and keyboards, opens devices in this way. If it may not, touches never
/// arrive, even if the device can be read.
InputDevices try_input_devices(const std::string& folder = "/dev/input");

}  // namespace turnpoint::io

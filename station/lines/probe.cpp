#include "station/lines/probe.hpp"

#include <fcntl.h>
#include <linux/input.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "station/lines/lines.hpp"
#include "station/lines/uri.hpp"
#include "station/system/file_descriptor.hpp"
#include "station/touch/evdev_device.hpp"

namespace turnpoint::lines {
namespace {

using Status = Finding::Status;

// True if the value of this key of a URI is the name of a line; false for keys with settings.
bool names_line(const std::string& key) {
  return key != "active" && key != "fault_active" && key != "stop_active" && key != "read_back" &&
         key != "hold_ms" && key != "refractory_ms" && key != "pulse_ms" && key != "axis";
}

Finding check_line(const std::string& device, const std::string& role, const std::string& line) {
  Finding check{device + " " + role, Status::ok, "", ""};
  try {
    const auto state = find_line(line);
    if (!state) {
      check.status = Status::failed;
      check.what = "no GPIO chip has a line named " + line;
      check.mend =
          gpio_chips().empty()
              ? "no GPIO chip can be opened: load the board's GPIO driver, and put the user into the group "
                "gpio"
              : "name the line in the device tree (gpio-line-names), or correct the rig file; gpioinfo lists "
                "them";
    } else if (state->used) {
      check.status = Status::failed;
      check.what = line + " is in use by " + (state->consumer.empty() ? "a driver" : state->consumer);
      check.mend =
          "end the other program; if a driver uses the line, remove the line from its device tree node";
    } else {
      check.what = line + " is line " + std::to_string(state->offset) + " of " + state->chip;
    }
  } catch (const std::exception& error) {
    check.status = Status::failed;
    check.what = error.what();
    check.mend = "put the user into the group that owns /dev/gpiochip*";
  }
  return check;
}

}  // namespace

std::vector<Finding> check_lines(const std::string& device, const std::string& text) {
  const Uri uri = parse_uri(text);
  if (uri.scheme != "gpio") return {{device, Status::ok, uri.scheme == "sim" ? "simulated" : uri.scheme, ""}};
  std::vector<Finding> checks;
  for (const auto& [key, line] : uri.values)
    if (names_line(key)) checks.push_back(check_line(device, key, line));
  return checks;
}

Finding check_touch(const std::string& device, const std::string& text) {
  const Uri uri = parse_uri(text);
  if (uri.scheme != "evdev") return {device, Status::ok, uri.scheme == "sim" ? "simulated" : uri.scheme, ""};
  const std::string mend =
      "plug the device in; its name is listed in /proc/bus/input/devices; the user must be in the group "
      "input";
  try {
    const auto panel = touch::EvdevDevice::find(uri.name);
    if (!panel)
      return {device, Status::failed,
              "input device '" + uri.name + "': " + std::generic_category().message(errno), mend};
    static_cast<void>(panel->range(panel->slot_count() > 0 ? ABS_MT_POSITION_X : ABS_X));
    return {device, Status::ok, "'" + uri.name + "' exists and has monotonic time stamps", ""};
  } catch (const std::exception& error) {
    return {device, Status::failed, error.what(), mend};
  }
}

InputDevices try_input_devices(const std::string& folder) {
  InputDevices found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (!entry.path().filename().string().starts_with("event")) continue;
    const system::FileDescriptor device(::open(entry.path().c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (!device.is_open()) {
      found.refused.push_back(entry.path().string() + ": " + std::generic_category().message(errno));
    } else {
      ++found.opened;
    }
  }
  std::sort(found.refused.begin(), found.refused.end());
  return found;
}

}  // namespace turnpoint::lines

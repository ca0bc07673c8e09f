#include "station/io/probe.hpp"

#include <fcntl.h>
#include <linux/input.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "station/core/file_descriptor.hpp"
#include "station/io/evdev_device.hpp"
#include "station/io/lines.hpp"
#include "station/io/uri.hpp"

namespace turnpoint::io {
namespace {

using Status = Finding::Status;
using core::Phrase, core::phrase, core::plain;

// True if the value of this key of a URI is the name of a line; false for keys with settings.
bool names_line(const std::string& key) {
  return key != "active" && key != "fault_active" && key != "stop_active" && key != "read_back" &&
         key != "hold_ms" && key != "refractory_ms" && key != "pulse_ms" && key != "axis";
}

Finding check_line(const Phrase& device, const std::string& role, const std::string& line) {
  Finding check{{"", "", {device, plain(" " + role)}}, Status::failed, {}, {}};
  try {
    const auto state = find_line(line);
    if (!state) {
      check.what = phrase("doctor.line_missing", {plain(line)});
      check.mend = phrase(gpio_chips().empty() ? "doctor.chip_mend" : "doctor.line_missing_mend");
    } else if (state->used) {
      const auto user = state->consumer.empty() ? phrase("doctor.a_driver") : plain(state->consumer);
      check.what = phrase("doctor.line_used", {plain(line), user});
      check.mend = phrase("doctor.line_used_mend");
    } else {
      check.status = Status::ok;
      check.what = phrase("doctor.line_good", {plain(line), plain(state->offset), plain(state->chip)});
    }
  } catch (const std::exception& error) {
    check.what = reported(error);
    check.mend = phrase("doctor.line_rights_mend");
  }
  return check;
}

/// The finding about a device that is not on lines of the kernel.
Finding elsewhere(const Phrase& device, const Uri& uri) {
  return {device, Status::ok, uri.scheme == "sim" ? phrase("doctor.simulated") : plain(uri.scheme), {}};
}

}  // namespace

Phrase reported(const std::exception& error) { return phrase("doctor.reported", {plain(error.what())}); }

std::vector<Finding> check_lines(const Phrase& device, const std::string& text) {
  const Uri uri = parse_uri(text);
  if (uri.scheme != "gpio") return {elsewhere(device, uri)};
  std::vector<Finding> checks;
  for (const auto& [key, line] : uri.values)
    if (names_line(key)) checks.push_back(check_line(device, key, line));
  return checks;
}

Finding check_touch(const Phrase& device, const std::string& text) {
  const Uri uri = parse_uri(text);
  if (uri.scheme != "evdev") return elsewhere(device, uri);
  const auto mend = phrase("doctor.touch_mend");
  try {
    const auto panel = EvdevDevice::find(uri.name);
    if (!panel)
      return {
          device, Status::failed,
          phrase("doctor.touch_missing", {plain(uri.name), plain(std::generic_category().message(errno))}),
          mend};
    static_cast<void>(panel->range(panel->slot_count() > 0 ? ABS_MT_POSITION_X : ABS_X));
    return {device, Status::ok, phrase("doctor.touch_good", {plain(uri.name)}), {}};
  } catch (const std::exception& error) {
    return {device, Status::failed, reported(error), mend};
  }
}

InputDevices try_input_devices(const std::string& folder) {
  InputDevices found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (!entry.path().filename().string().starts_with("event")) continue;
    const core::FileDescriptor device(::open(entry.path().c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC));
    if (!device.is_open()) {
      found.refused.push_back(entry.path().string() + ": " + std::generic_category().message(errno));
    } else {
      ++found.opened;
    }
  }
  std::sort(found.refused.begin(), found.refused.end());
  return found;
}

}  // namespace turnpoint::io

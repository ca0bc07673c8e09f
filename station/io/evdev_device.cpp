#include "station/io/evdev_device.hpp"

#include <fcntl.h>
#include <libevdev/libevdev.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "station/core/usage_error.hpp"

namespace turnpoint::io {

namespace {

[[noreturn]] void fail(int error, const std::string& name, const std::string& what) {
  throw std::system_error(error, std::generic_category(), "input device '" + name + "'" + what);
}

int open_for_reading(const std::string& path) {
  return ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
}

std::int64_t time_of(const input_event& event) {
  return std::int64_t{1'000'000'000} * event.input_event_sec + std::int64_t{1000} * event.input_event_usec;
}

}  // namespace

void EvdevDevice::Free::operator()(libevdev* device) const noexcept { libevdev_free(device); }

std::optional<EvdevDevice> EvdevDevice::find(const std::string& path_or_name, const std::string& folder) {
  if (path_or_name.starts_with('/')) {
    const int descriptor = open_for_reading(path_or_name);
    if (descriptor < 0) return std::nullopt;
    return EvdevDevice(descriptor, path_or_name);
  }
  int error = ENOENT;
  std::error_code none;
  std::vector<std::pair<std::string, EvdevDevice>> named;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none)) {
    if (!entry.path().filename().string().starts_with("event")) continue;
    const int descriptor = open_for_reading(entry.path());
    if (descriptor < 0) {
      error = errno;
      continue;
    }
    try {
      EvdevDevice device(descriptor, path_or_name);
      if (libevdev_get_name(device.device_.get()) == path_or_name)
        named.emplace_back(entry.path().string(), std::move(device));
      // this device may just have been unplugged; try the next one
    } catch (const std::system_error& going) {
      error = going.code().value();
    }
  }
  // A touch controller often has another node of the same name, such as that of a mouse that reports
  // positions.
  if (std::any_of(named.begin(), named.end(), [](const auto& one) { return one.second.is_touched(); }))
    std::erase_if(named, [](const auto& one) { return !one.second.is_touched(); });
  if (named.size() > 1) {
    std::sort(named.begin(), named.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string paths;
    for (const auto& one : named) paths += (paths.empty() ? "" : ", ") + one.first;
    throw core::UsageError("input device '" + path_or_name + "': " + std::to_string(named.size()) +
                           " devices have this name: " + paths +
                           "; write the path of one of them, best a link below /dev/input/by-path, which "
                           "stays the same after a restart");
  }
  if (named.size() == 1) return std::move(named.front().second);
  errno = error;
  return std::nullopt;
}

EvdevDevice::EvdevDevice(int descriptor, std::string name) : file_(descriptor), name_(std::move(name)) {
  libevdev* device = nullptr;
  int error = libevdev_new_from_fd(descriptor, &device);
  device_.reset(device);
  if (error == 0) error = libevdev_set_clock_id(device, CLOCK_MONOTONIC);
  if (error == 0) return;
  fail(-error, name_, "");
}

bool EvdevDevice::has_axis(int axis) const noexcept {
  return libevdev_has_event_code(device_.get(), EV_ABS, static_cast<unsigned>(axis)) != 0;
}

bool EvdevDevice::is_touched() const noexcept {
  return has_axis(ABS_MT_POSITION_X) || libevdev_has_event_code(device_.get(), EV_KEY, BTN_TOUCH) != 0;
}

AxisRange EvdevDevice::range(int axis) const {
  const auto* found = libevdev_get_abs_info(device_.get(), static_cast<unsigned>(axis));
  const std::string named = ": axis " + std::to_string(axis);
  if (found == nullptr) fail(ENOTSUP, name_, named);
  if (found->maximum <= found->minimum)
    fail(ENOTSUP, name_,
         named + " reports " + std::to_string(found->minimum) + " ... " + std::to_string(found->maximum) +
             "; the second must be the larger");
  return {found->minimum, found->maximum};
}

EvdevDevice::News EvdevDevice::next() {
  input_event event{};
  for (;;) {
    int status = libevdev_next_event(device_.get(), LIBEVDEV_READ_FLAG_NORMAL, &event);
    if (status == -EAGAIN || status == -EINTR) return News::none;
    if (status < 0) fail(-status, name_, "");
    if (status == LIBEVDEV_READ_STATUS_SUCCESS && event.type == EV_SYN && event.code == SYN_REPORT) {
      time_ns_ = time_of(event);
      return News::report;
    }
    if (status != LIBEVDEV_READ_STATUS_SYNC) continue;
    time_ns_ = time_of(event);
    while (status == LIBEVDEV_READ_STATUS_SYNC)
      status = libevdev_next_event(device_.get(), LIBEVDEV_READ_FLAG_SYNC, &event);
    if (status != -EAGAIN)
      fail(-status, name_, ": cannot read the positions of the fingers, although events were lost");
    return News::resynchronised;
  }
}

bool EvdevDevice::key(int code) const noexcept {
  return libevdev_get_event_value(device_.get(), EV_KEY, static_cast<unsigned>(code)) != 0;
}

int EvdevDevice::axis(int axis) const noexcept {
  return libevdev_get_event_value(device_.get(), EV_ABS, static_cast<unsigned>(axis));
}

int EvdevDevice::slot_count() const noexcept {
  const int count = libevdev_get_num_slots(device_.get());
  return count < 0 ? 0 : count;
}

int EvdevDevice::slot(int slot, int code) const noexcept {
  return libevdev_get_slot_value(device_.get(), static_cast<unsigned>(slot), static_cast<unsigned>(code));
}

}  // namespace turnpoint::io

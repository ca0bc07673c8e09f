#include "station/io/evdev_contact.hpp"

#include <linux/input.h>
#include <poll.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <system_error>
#include <utility>

namespace turnpoint::io {

std::optional<Contact> ContactReader::take(std::int64_t time_ns, bool on, int position) noexcept {
  const double share = static_cast<double>(position - range_.lowest) / (range_.highest - range_.lowest);
  const double place = std::clamp(share, 0.0, 1.0);  // some devices report more than their range
  const bool moved = on && std::abs(place - told_) >= 0.01;
  if (on == told_on_ && !moved) return std::nullopt;
  told_on_ = on;
  told_ = place;
  return Contact{time_ns, on, place};
}

namespace {

EvdevDevice found(const std::string& name) {
  if (auto device = EvdevDevice::find(name)) return std::move(*device);
  throw std::system_error(errno, std::generic_category(),
                          "touch sensor '" + name + "': no input device with this name can be opened");
}

}  // namespace

EvdevContact::EvdevContact(const std::string& name, int axis)
    : device_(found(name)), axis_(axis), reader_(device_.range(axis)) {}

std::optional<Contact> EvdevContact::wait(std::int64_t timeout_ns) {
  for (;;) {
    if (device_.next() != EvdevDevice::News::none) {
      const auto touch = reader_.take(device_.time_ns(), device_.key(BTN_TOUCH), device_.axis(axis_));
      if (touch) return touch;
      continue;
    }
    pollfd wanted{device_.descriptor(), POLLIN, 0};
    const timespec timeout{timeout_ns / 1'000'000'000, timeout_ns % 1'000'000'000};
    if (::ppoll(&wanted, 1, &timeout, nullptr) <= 0) return std::nullopt;
    if (wanted.revents & (POLLERR | POLLHUP))
      throw std::system_error(ENODEV, std::generic_category(), "touch sensor '" + device_.name() + "'");
  }
}

}  // namespace turnpoint::io

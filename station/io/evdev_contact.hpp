#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "station/io/contact.hpp"
#include "station/io/evdev_device.hpp"

namespace turnpoint::io {

/// Converts a touch sensor's states to contacts. Uses no clock and no device.
class ContactReader {
 public:
  /// Scales positions from `range` to [0, 1].
  explicit ContactReader(AxisRange range) noexcept : range_(range) {}

  /// Takes the sensor's state at the end of a report. Returns a contact if the finger came, left, or moved by
  /// at least a hundredth of the range.
  std::optional<Contact> take(std::int64_t time_ns, bool on, int position) noexcept;

 private:
  AxisRange range_;
  bool told_on_ = false;
  double told_ = -1;
};

/// The touch sensor of the surface. It is found by the name of its input device.
class EvdevContact {
 public:
  /// `axis` is ABS_X or ABS_Y. Throws std::system_error: ENOENT if no input device has this name, ENOTSUP if
  /// the device does not have this axis.
  EvdevContact(const std::string& name, int axis);

  /// Waits up to `timeout_ns` for the next contact and returns it with the kernel's time stamp. If the kernel
  /// lost events, the contact has the time at which the loss began. Throws std::system_error with ENODEV when
  /// the device is unplugged.
  std::optional<Contact> wait(std::int64_t timeout_ns);

 private:
  EvdevDevice device_;
  int axis_;
  ContactReader reader_;
};

}  // namespace turnpoint::io

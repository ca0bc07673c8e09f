#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "station/touch/contact.hpp"
#include "station/touch/evdev_device.hpp"

namespace turnpoint::touch {

/// Turns the states of a touch sensor into contacts. Pure.
class ContactReader {
 public:
  /// Positions are scaled from `range` to [0, 1].
  explicit ContactReader(AxisRange range) noexcept : range_(range) {}

  /// The state at the end of a report. Returns the contact if the finger came, moved by a hundredth or more,
  /// or went.
  std::optional<Contact> take(std::int64_t time_ns, bool on, int position) noexcept;

 private:
  AxisRange range_;
  bool told_on_ = false;
  double told_ = -1;
};

/// A touch sensor, found by the name of its input device.
class EvdevContact {
 public:
  /// `axis` is ABS_X or ABS_Y. Throws std::system_error: ENOENT where no input device has the name, ENOTSUP
  /// where it has no such axis.
  EvdevContact(const std::string& name, int axis);

  /// The next contact within `timeout_ns`, with the kernel's stamp. One that was found after lost events has
  /// the time when the loss began. Throws std::system_error with ENODEV when the device is unplugged.
  std::optional<Contact> wait(std::int64_t timeout_ns);

 private:
  EvdevDevice device_;
  int axis_;
  ContactReader reader_;
};

}  // namespace turnpoint::touch

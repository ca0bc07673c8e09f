#pragma once
#include <linux/input.h>

#include <cstdint>
#include <optional>
#include <string>

#include "station/panel/buttons.hpp"

namespace turnpoint::panel {

/// Turns the kernel's input events of a touch sensor into contacts, report by report. Pure.
class ContactReader {
 public:
  /// `axis` is ABS_X or ABS_Y; positions are scaled from [minimum, maximum] to [0, 1].
  ContactReader(int axis, int minimum, int maximum) noexcept
      : axis_(axis), minimum_(minimum), maximum_(maximum) {}

  /// An event; at the end of a report (SYN_REPORT) in which the finger came, moved by a hundredth or more, or
  /// went: the contact, stamped by the kernel. After SYN_DROPPED the state is taken up at the next report.
  std::optional<Touch> take(const input_event& event) noexcept;
  bool dropped() const noexcept { return dropped_; }  ///< events were lost since the last call of recovered()
  void recovered(bool on, int position) noexcept;

 private:
  int axis_, minimum_, maximum_;
  bool on_ = false, told_on_ = false, dropped_ = false;
  int raw_ = 0;
  double told_ = -1;
};

/// A touch sensor opened by the name of its input device, read-only, time stamps from CLOCK_MONOTONIC.
class EvdevContact {
 public:
  /// Throws std::system_error: ENOENT where no input device has the name, ENOTSUP where it has no such axis.
  EvdevContact(const std::string& name, int axis);
  ~EvdevContact();
  EvdevContact(const EvdevContact&) = delete;
  EvdevContact& operator=(const EvdevContact&) = delete;

  /// The next contact within `timeout_ns`. Throws std::system_error with ENODEV when the device is unplugged.
  std::optional<Touch> wait(std::int64_t timeout_ns);

 private:
  void resynchronise();
  int descriptor_ = -1;
  int axis_;
  std::string name_;
  std::optional<ContactReader> reader_;
};

}  // namespace turnpoint::panel

#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "station/core/file_descriptor.hpp"

struct libevdev;

namespace turnpoint::io {

/// The range of values that an axis reports.
struct AxisRange {
  int lowest = 0, highest = 0;
};

/// A kernel input device, which libevdev reads report by report. key(), axis() and slot() give the state at
/// the end of the last report. Time stamps are from CLOCK_MONOTONIC. Other programs can read the same device
/// at the same time. Use an object from one thread only.
class EvdevDevice {
 public:
  /// Opens the device with this path or (without a leading slash) this name in `folder`, for reading only.
  /// Empty if there is no such device or it cannot be opened; errno says why. Of several devices of this
  /// name, takes the one that is_touched(). Throws core::UsageError if several are, or if several have the
  /// name and none is, and std::system_error if the path is not an input device.
  static std::optional<EvdevDevice> find(const std::string& path_or_name,
                                         const std::string& folder = "/dev/input");

  /// Takes ownership of an open, non-blocking descriptor. Throws std::system_error.
  EvdevDevice(int descriptor, std::string name);

  const std::string& name() const noexcept { return name_; }
  int descriptor() const noexcept { return file_.get(); }
  bool has_axis(int axis) const noexcept;
  /// True for a panel or a sensor that a finger or a pen touches, which reports the touch itself; false for a
  /// keyboard and for a mouse, also one that reports positions (a touch controller often has such a node).
  bool is_touched() const noexcept;
  /// Throws std::system_error with ENOTSUP if the device has no such axis, or if its range is empty.
  AxisRange range(int axis) const;

  enum class News {
    none,    ///< no event is waiting
    report,  ///< a report is complete
    /// the kernel dropped events: the state is up to date, but the events that led to it are unknown
    resynchronised,
  };
  /// Reads up to the end of the next report, without waiting. Throws std::system_error with ENODEV if the
  /// device is gone.
  News next();

  /// Time of the last report; after `resynchronised`, the time at which the kernel began to drop events.
  std::int64_t time_ns() const noexcept { return time_ns_; }
  /// The current state: whether a key is pressed, and the value of an axis. slot() gives the value for one
  /// finger of a multitouch panel.
  bool key(int code) const noexcept;
  int axis(int axis) const noexcept;
  int slot_count() const noexcept;  ///< 0 if the device cannot tell fingers apart
  int slot(int slot, int code) const noexcept;

 private:
  struct Free {
    void operator()(libevdev* device) const noexcept;
  };
  core::FileDescriptor file_;
  std::string name_;
  std::unique_ptr<libevdev, Free> device_;
  std::int64_t time_ns_ = 0;
};

}  // namespace turnpoint::io

#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "station/system/file_descriptor.hpp"

struct libevdev;

namespace turnpoint::touch {

/// What values an axis reports.
struct AxisRange {
  int lowest = 0, highest = 0;
};

/// An input device of the kernel, read by libevdev report by report: between two calls of next() the state
/// is that at the end of a report. Stamps are from CLOCK_MONOTONIC. Other programs read the same device
/// undisturbed. One thread at a time.
class EvdevDevice {
 public:
  /// Opens the device of this path or, without a slash in front, of this name, for reading only. None where
  /// there is no such device now, or it cannot be opened; errno says why. Throws std::system_error for
  /// something that is no input device.
  static std::optional<EvdevDevice> find(const std::string& path_or_name);

  /// Takes over an open descriptor that does not block. Throws std::system_error.
  EvdevDevice(int descriptor, std::string name);

  const std::string& name() const noexcept { return name_; }
  int descriptor() const noexcept { return file_.get(); }
  bool has_axis(int axis) const noexcept;
  /// Throws std::system_error with ENOTSUP where the device has no such axis or it has no extent.
  AxisRange range(int axis) const;

  enum class News {
    none,            ///< nothing waits
    report,          ///< a report is complete
    resynchronised,  ///< the kernel dropped events; the state is that of now, what led to it is unknown
  };
  /// Reads on to the end of the next report, without waiting. Throws std::system_error with ENODEV when the
  /// device has gone.
  News next();

  /// When the last report was made; after resynchronised, when the kernel began to drop events.
  std::int64_t time_ns() const noexcept { return time_ns_; }
  /// The state: whether a key is down, where an axis is, and the same of each finger of a multitouch panel.
  bool key(int code) const noexcept;
  int axis(int axis) const noexcept;
  int slot_count() const noexcept;  ///< 0 where the device does not tell fingers apart
  int slot(int slot, int code) const noexcept;

 private:
  struct Free {
    void operator()(libevdev* device) const noexcept;
  };
  system::FileDescriptor file_;
  std::string name_;
  std::unique_ptr<libevdev, Free> device_;
  std::int64_t time_ns_ = 0;
};

}  // namespace turnpoint::touch

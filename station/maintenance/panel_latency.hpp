#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "station/rig/calibration.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::io {
class Buttons;
}
namespace turnpoint::io {
class TouchReader;
}

namespace turnpoint::maintenance {

/// The options of `turnpoint calibrate --panel`.
struct LatencyRequest {
  std::string rig;
  rig::LatencyReference reference = rig::LatencyReference::button;
};

/// The devices for measuring the latency of the touch panel: the panel, if the rig names it, and the rig's
/// button lines, one of which gives the reference time.
class LatencyDevices {
 public:
  using OnEdge = std::function<void(std::int64_t time_ns)>;

  /// `on_edge` is called on the thread that watches the buttons. Throws core::UsageError for a rig without
  /// real buttons, and the errors of io::open_buttons and io::TouchReader.
  LatencyDevices(const rig::Rig& rig, OnEdge on_edge);

  ~LatencyDevices();

  /// True if touches have the kernel's time stamps.
  bool has_kernel_times() const { return touch_ != nullptr; }
  /// Returns the kernel's time stamp of the touch at this place; see io::TouchReader::claim(). Empty if
  /// touches do not have the kernel's time stamps.
  std::optional<std::int64_t> claim(double x, double y, std::int64_t seen_ns);

 private:
  std::unique_ptr<io::TouchReader> touch_;
  std::unique_ptr<io::Buttons> buttons_;
};

/// Returns the known calibration with this latency of the panel. If it already has a latency measured with
/// the other reference (button or photodiode), that value is kept. The latency gets today's date.
rig::Calibration with_panel(const rig::Rig& rig, const rig::PanelLatency& measured,
                            const std::string& out = "");
/// Writes that calibration beside the rig file, and returns its path. Throws std::system_error.
std::string keep_panel(const rig::Rig& rig, const rig::PanelLatency& measured);

/// Returns the calibration whose parts a new one keeps: the file `out` if it exists, since it will be
/// overwritten; otherwise the newest valid calibration beside the rig file; without one, a calibration with
/// nothing in it. Throws core::UsageError if `out` has expired or belongs to another rig file, and
/// core::BadInput if it cannot be read.
rig::Calibration known_calibration(const rig::Rig& rig, const std::string& out = "");

/// Copies the parts of a calibration that separate commands measure (panel, pick-ups, force cells) from the
/// known calibration.
void keep_devices(const rig::Rig& rig, rig::Calibration& made, const std::string& out = "");

}  // namespace turnpoint::maintenance

#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "station/calibration/calibration.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::lines {
class Buttons;
}
namespace turnpoint::touch {
class TouchReader;
}

namespace turnpoint::maintenance {

/// The options of `turnpoint calibrate --panel`.
struct LatencyRequest {
  std::string rig;
  calibration::LatencyReference reference = calibration::LatencyReference::button;
};

/// The devices for measuring a panel's latency: the touch panel's kernel times, if the rig names the panel,
/// and the rig's button lines, one of which is the reference.
class LatencyDevices {
 public:
  using OnEdge = std::function<void(std::int64_t time_ns)>;

  /// `on_edge` is called on the panel's thread. Throws terms::UsageError for a rig without real buttons, and
  /// the errors of lines::open_buttons and touch::TouchReader.
  LatencyDevices(const rig::Rig& rig, OnEdge on_edge);

  ~LatencyDevices();

  /// True if touches get the kernel's time.
  bool has_kernel_times() const { return touch_ != nullptr; }
  /// See touch::TouchReader::claim(); empty without kernel times.
  std::optional<std::int64_t> claim(double x, double y, std::int64_t seen_ns);

 private:
  std::unique_ptr<touch::TouchReader> touch_;
  std::unique_ptr<lines::Buttons> buttons_;
};

/// The calibration to which a panel's latency is added: the newest one beside the rig if it is still valid,
/// else a new one that contains nothing else. A latency measured with the other reference is kept. Has
/// today's date.
calibration::Calibration with_panel(const rig::Rig& rig, const calibration::PanelLatency& measured);

/// The panel's latency from the newest valid calibration beside the rig.
std::optional<calibration::PanelLatency> known_panel(const rig::Rig& rig);

}  // namespace turnpoint::maintenance

#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "station/touch/evdev_device.hpp"

namespace turnpoint::touch {

/// A finger that came down on a touch panel, by the kernel's own time stamp.
struct PanelTouch {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC
  double x = 0, y = 0;       ///< 0 ... 1 from the panel's left and top
};

/// Where a finger is, in the panel's own units.
struct Finger {
  std::optional<int> id;  ///< another number for each touch; none while no finger is there
  int x = 0, y = 0;
};

/// Tells from a panel's reports which fingers have come down. Pure: states in, touches out.
class TouchDecoder {
 public:
  TouchDecoder(AxisRange x, AxisRange y) noexcept : x_(x), y_(y) {}

  /// The panel's fingers at the end of a report, always in the same order. Returns those that came down
  /// since the last call.
  std::vector<PanelTouch> report(std::int64_t time_ns, std::span<const Finger> fingers);

  /// The fingers after reports were lost, or at the start. Nobody knows when they came down, so they are no
  /// touches.
  void resynchronise(std::span<const Finger> fingers);

 private:
  AxisRange x_, y_;
  std::vector<Finger> before_;
};

}  // namespace turnpoint::touch

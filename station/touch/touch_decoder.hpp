#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "station/touch/evdev_device.hpp"

namespace turnpoint::touch {

/// A finger that came down on a touch panel, with the kernel's time stamp.
struct PanelTouch {
  std::int64_t time_ns = 0;  ///< time on CLOCK_MONOTONIC
  double x = 0, y = 0;       ///< from 0 to 1, measured from the panel's left and top
};

/// The state of one finger on a panel. x and y are in the panel's own units.
struct Finger {
  std::optional<int> id;  ///< a different number for each touch; empty while no finger is there
  int x = 0, y = 0;
};

/// Compares a panel's successive reports and returns the fingers that have come down. Uses no clock and no
/// device.
class TouchDecoder {
 public:
  TouchDecoder(AxisRange x, AxisRange y) noexcept : x_(x), y_(y) {}

  /// Takes the panel's fingers at the end of a report, always in the same order. Returns the fingers that
  /// came down since the previous call.
  std::vector<PanelTouch> report(std::int64_t time_ns, std::span<const Finger> fingers);

  /// Takes the fingers that are on the panel at the start, or after reports were lost. It is unknown when
  /// they came down, so they do not count as touches.
  void resynchronise(std::span<const Finger> fingers);

 private:
  AxisRange x_, y_;
  std::vector<Finger> before_;
};

}  // namespace turnpoint::touch

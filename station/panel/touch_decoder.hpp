#pragma once
#include <linux/input.h>

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace turnpoint::panel {

/// A finger that came down on a touch panel, by the kernel's own time stamp.
struct PanelTouch {
  std::int64_t time_ns = 0;  ///< CLOCK_MONOTONIC
  double x = 0, y = 0;       ///< 0 ... 1 from the panel's left and top
};

/// What values an axis reports. Throws std::invalid_argument in TouchDecoder where highest <= lowest.
struct AxisRange {
  int lowest = 0, highest = 0;
};

/// Which protocol the device speaks (Documentation/input/multi-touch-protocol.rst of the kernel).
enum class TouchProtocol { single, slots };

/// Turns a panel's evdev events into touches, one for each finger that comes down. Pure: events in, touches
/// out. After SYN_DROPPED everything up to the next report is thrown away, as the kernel demands.
class TouchDecoder {
 public:
  TouchDecoder(TouchProtocol protocol, AxisRange x, AxisRange y);

  /// The touches that this event completes: none but at a SYN_REPORT.
  std::vector<PanelTouch> handle(const input_event& event);

 private:
  struct Finger {
    std::optional<int> x, y;
    bool began = false;
  };
  void handle_axis(const input_event& event);
  std::vector<PanelTouch> report(std::int64_t time_ns);

  TouchProtocol protocol_;
  AxisRange x_, y_;
  std::map<int, Finger> fingers_;
  int slot_ = 0;
  bool dropped_ = false;
};

}  // namespace turnpoint::panel

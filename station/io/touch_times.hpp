#pragma once
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "station/io/evdev_device.hpp"

namespace turnpoint::io {

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

/// Finds the kernel's time stamp of a touch that a toolkit reports. The kernel knows when the panel was
/// touched; the toolkit knows what was touched. A kernel touch matches if it lies within `nearness` (in units
/// of the panel's width and height) of the toolkit's touch and at most `latest_ns` before the toolkit saw it.
/// If several kernel touches match, none is used. May be used from any thread.
class TouchTimes {
 public:
  struct Rules {
    double nearness = 0.04;
    /// longest time from the kernel's time stamp until the toolkit sees the touch
    std::int64_t latest_ns = 400'000'000;
  };

  TouchTimes() = default;
  explicit TouchTimes(const Rules& rules) : rules_(rules) {}

  void add(const PanelTouch& touch);

  /// Returns the kernel's time of the touch at (x, y), each from 0 to 1, that the toolkit saw at `seen_ns`.
  /// Empty if no kernel touch matches, or more than one. Each kernel touch is used at most once; touches that
  /// made a match ambiguous are not used again.
  std::optional<std::int64_t> claim(double x, double y, std::int64_t seen_ns);

 private:
  Rules rules_;
  std::mutex mutex_;
  std::deque<PanelTouch> touches_;
};

}  // namespace turnpoint::io

#pragma once
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "station/touch/touch_decoder.hpp"

namespace turnpoint::touch {

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

}  // namespace turnpoint::touch

#pragma once
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "station/touch/touch_decoder.hpp"

namespace turnpoint::touch {

/// Finds the kernel's time for a touch that a toolkit reports: evdev tells when, the toolkit tells what was
/// touched. A pair is made only where it is beyond doubt: exactly one kernel touch lies within `nearness` (of
/// the panel's width and height) and at most `latest_ns` before the toolkit saw it. Never a guess. Any
/// thread.
class TouchTimes {
 public:
  struct Rules {
    double nearness = 0.04;
    std::int64_t latest_ns = 400'000'000;  ///< a GUI thread that is later than this has other troubles
  };

  TouchTimes() = default;
  explicit TouchTimes(const Rules& rules) : rules_(rules) {}

  void add(const PanelTouch& touch);

  /// The kernel's time of the touch at (x, y), each 0 ... 1, that the toolkit saw at `seen_ns`; none where no
  /// touch or more than one fits. What is claimed is used up, and so is all that left it in doubt.
  std::optional<std::int64_t> claim(double x, double y, std::int64_t seen_ns);

 private:
  Rules rules_;
  std::mutex mutex_;
  std::deque<PanelTouch> touches_;
};

}  // namespace turnpoint::touch

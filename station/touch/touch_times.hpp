#pragma once
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "station/touch/touch_decoder.hpp"

namespace turnpoint::touch {

/// Finds the kernel's time for a touch that a toolkit reports: evdev knows when, the toolkit knows what was
/// touched. A match is made only if it is beyond doubt: exactly one kernel touch lies within `nearness` (in
/// units of the panel's width and height) and at most `latest_ns` before the toolkit saw it. It never
/// guesses. May be used from any thread.
class TouchTimes {
 public:
  struct Rules {
    double nearness = 0.04;
    std::int64_t latest_ns = 400'000'000;  ///< if the GUI thread is later than this, there are other problems
  };

  TouchTimes() = default;
  explicit TouchTimes(const Rules& rules) : rules_(rules) {}

  void add(const PanelTouch& touch);

  /// The kernel's time of the touch at (x, y), each from 0 to 1, that the toolkit saw at `seen_ns`; empty if
  /// no touch fits or more than one does. A matched touch cannot be matched again, nor can touches that made
  /// a match ambiguous.
  std::optional<std::int64_t> claim(double x, double y, std::int64_t seen_ns);

 private:
  Rules rules_;
  std::mutex mutex_;
  std::deque<PanelTouch> touches_;
};

}  // namespace turnpoint::touch

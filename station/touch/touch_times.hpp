#pragma once
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>

#include "station/touch/touch_decoder.hpp"

namespace turnpoint::touch {

/// Finds the kernel's time stamp of a touch that a toolkit reports. The kernel knows when the panel was
/// touched, the toolkit knows what was touched. Two touches match only if there is no doubt: exactly one
/// kernel touch lies within `nearness` (in units of the panel's width and height) and at most `latest_ns`
/// before the toolkit saw the touch. May be used from any thread.
class TouchTimes {
 public:
  struct Rules {
    double nearness = 0.04;
    std::int64_t latest_ns = 400'000'000;  ///< a touch is not matched if the toolkit sees it later than this
  };

  TouchTimes() = default;
  explicit TouchTimes(const Rules& rules) : rules_(rules) {}

  void add(const PanelTouch& touch);

  /// Returns the kernel's time of the touch at (x, y), each from 0 to 1, that the toolkit saw at `seen_ns`.
  /// Empty if no kernel touch fits, or more than one. A kernel touch is used once only; those that made a
  /// match ambiguous are not used again either.
  std::optional<std::int64_t> claim(double x, double y, std::int64_t seen_ns);

 private:
  Rules rules_;
  std::mutex mutex_;
  std::deque<PanelTouch> touches_;
};

}  // namespace turnpoint::touch

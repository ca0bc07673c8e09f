#pragma once
#include <optional>

#include "station/system/clocks.hpp"

namespace turnpoint::system {

/// Detects that the machine was suspended, or that somebody set its clock. Reads no clock itself: it compares
/// the readings that the caller passes.
class ClockWatch {
 public:
  explicit ClockWatch(const Clocks& start) noexcept : last_(start) {}

  struct News {
    std::optional<double> suspended_s;  ///< how long the machine slept
    std::optional<double> jump_s;       ///< how much the wall clock was changed, not counting time asleep
  };
  /// Returns what has happened since the previous call. Slow corrections by a time service (at most 500 ppm)
  /// do not count as a jump.
  News look(const Clocks& now) noexcept;

 private:
  Clocks last_;
};

}  // namespace turnpoint::system

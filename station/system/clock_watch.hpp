#pragma once
#include <optional>

#include "station/system/clocks.hpp"

namespace turnpoint::system {

/// Sees that the machine was suspended, or that somebody set its clock. Pure.
class ClockWatch {
 public:
  explicit ClockWatch(const Clocks& start) noexcept : last_(start) {}

  struct News {
    std::optional<double> suspended_s;  ///< how long the machine slept
    std::optional<double> jump_s;       ///< by how much the wall clock was set, sleep taken off
  };
  /// What happened since the last look. Steering by a time service (at most 500 ppm) is no jump.
  News look(const Clocks& now) noexcept;

 private:
  Clocks last_;
};

}  // namespace turnpoint::system

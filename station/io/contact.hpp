#pragma once
#include <cstdint>
#include <optional>

namespace turnpoint::io {

/// A change of a finger's contact with the surface of the rig: it touches, moves, or leaves.
struct Contact {
  std::int64_t time_ns = 0;
  bool on = false;
  /// position along the surface, from 0 at one end of the sensor to 1 at the other; empty if the sensor does
  /// not report it
  std::optional<double> position;
};

}  // namespace turnpoint::io

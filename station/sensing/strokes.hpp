#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "station/sensing/finger_track.hpp"

namespace turnpoint::sensing {

/// A movement of the finger in one direction, as a range of points of its track.
struct Stroke {
  /// points of the stroke without 5 mm at each end, where the skin's deflection changes direction
  std::size_t first = 0, end = 0;
  int direction = 0;  ///< 1 towards larger positions, -1 towards smaller positions
};

/// Finds the strokes in a track. A stroke is faster than 10 mm/s without interruption, and at least 30 mm
/// long including its ends.
std::vector<Stroke> find_strokes(std::span<const FingerPoint> track);

}  // namespace turnpoint::sensing

#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "station/sensing/finger_track.hpp"

namespace turnpoint::sensing {

/// A movement of the finger in one direction, as a range of indices into the track of the finger.
struct Stroke {
  /// the points of the stroke except 5 mm at each end, where the direction of the skin's deflection changes
  std::size_t first = 0, end = 0;
  int direction = 0;  ///< 1 towards larger positions, -1 towards smaller positions
};

/// Finds the strokes in a track. A stroke is faster than 10 mm/s without interruption, and at least 30 mm
/// long including its ends.
std::vector<Stroke> find_strokes(std::span<const FingerPoint> track);

}  // namespace turnpoint::sensing

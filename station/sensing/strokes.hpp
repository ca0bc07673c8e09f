#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "station/sensing/finger_track.hpp"

namespace turnpoint::sensing {

/// A movement of the finger in one direction, as a range of points of its track.
struct Stroke {
  std::size_t first = 0, end = 0;  ///< without 5 mm at both ends, where the skin still turns round
  int direction = 0;               ///< 1 towards larger positions, -1 towards smaller ones
};

/// Finds the strokes: faster than 10 mm/s without interruption, 30 mm or longer (before the ends are
/// dropped).
std::vector<Stroke> find_strokes(std::span<const FingerPoint> track);

}  // namespace turnpoint::sensing

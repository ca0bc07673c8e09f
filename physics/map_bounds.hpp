#pragma once
// Estimates how far three effects can move a boundary: errors of the model's equation, higher modes from the
// drive edge, and uncertain parameters.
#include <string>

#include "physics/boundary_map.hpp"

namespace turnpoint::physics {

struct MapBounds {
  double equation_m = 0;     // error of the model against the exact (or best) first transverse mode
  double drive_modes_m = 0;  // effect of the drive edge's higher transverse modes
  double uncertainty_m = 0;  // one standard deviation, computed from the surface's `sd`
  std::string reason;
  double error_m() const { return equation_m + drive_modes_m; }
};

MapBounds map_bounds(const Surface& surface, const MapOptions& options, double frequency_Hz,
                     double boundary_m);

// Explains why an edge has no position at a frequency.
std::string why_no_boundary(const Surface& surface, const MapOptions& options, double frequency_Hz);

}  // namespace turnpoint::physics

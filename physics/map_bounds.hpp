#pragma once
// Effects that can move a boundary: the model's equation, the drive edge's higher modes, the parameters.
#include <string>

#include "physics/boundary_map.hpp"

namespace turnpoint::physics {

struct MapBounds {
  double equation_m = 0;     // model against the exact (or best) first transverse mode
  double drive_modes_m = 0;  // higher transverse modes of the drive edge
  double uncertainty_m = 0;  // one standard deviation from the surface's sd
  std::string reason;
  double error_m() const { return equation_m + drive_modes_m; }
};

MapBounds map_bounds(const Surface& surface, const MapOptions& options, double frequency_Hz,
                     double boundary_m);

// Why an edge has no position at a frequency.
std::string why_no_boundary(const Surface& surface, const MapOptions& options, double frequency_Hz);

}  // namespace turnpoint::physics

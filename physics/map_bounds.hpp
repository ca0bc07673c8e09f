#pragma once
// Estimates how far two effects can move a boundary: the error of the model's equation, and higher modes from
// the drive edge.
#include <string>

#include "physics/boundary_map.hpp"

namespace turnpoint::physics {

struct MapBounds {
  // distance between the boundary by the model and the boundary by the best equation for the first mode
  double equation_m = 0;
  double drive_modes_m = 0;  // how far higher transverse modes from the drive edge shift the boundary
  std::string reason;
  double error_m() const { return equation_m + drive_modes_m; }
};

MapBounds map_bounds(const Surface& surface, const MapOptions& options, double frequency_Hz,
                     double boundary_m);

// True if slightly more loss would make the last maximum of the first mode disappear or move far away. The
// last maximum of the two-dimensional field may then be somewhere else. This happens only with strong loss.
bool peak_is_shallow(const Surface& surface, double frequency_Hz, double last_peak_m);

// Returns a sentence that explains why there is no boundary on the surface at this frequency.
std::string why_no_boundary(const Surface& surface, const MapOptions& options, double frequency_Hz);

}  // namespace turnpoint::physics

#pragma once
// Finds the last maximum, and the point with a given level, of a centre line that can be evaluated only point
// by point.
#include <optional>

#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// Finds the outermost maximum of |v| at or before `from_m`. It compares samples `spacing_m` apart and then
// refines the position to rounding accuracy.
std::optional<double> find_last_peak(const CentreLine& line, double from_m, double spacing_m);

// First point beyond peak_m at which |v| is `level` times its value at peak_m; empty if there is none up to
// length_m.
std::optional<double> find_level(const CentreLine& line, double peak_m, double length_m, double spacing_m,
                                 double level);

}  // namespace turnpoint::physics

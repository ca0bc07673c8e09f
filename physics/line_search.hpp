#pragma once
// Features of a centre line that is known only point by point.
#include <optional>

#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// Outermost maximum of |v| at or before `from_m`, by samples `spacing_m` apart and refinement to rounding.
std::optional<double> find_last_peak(const CentreLine& line, double from_m, double spacing_m);

// First point beyond peak_m at which |v| is `level` of its value there; empty if it stays above up to
// length_m.
std::optional<double> find_level(const CentreLine& line, double peak_m, double length_m, double spacing_m,
                                 double level);

}  // namespace turnpoint::physics

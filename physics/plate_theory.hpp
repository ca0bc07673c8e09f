#pragma once
// Computes how far the choice of a plate theory moves a boundary, and chooses a theory that is accurate
// enough.
#include <optional>
#include <span>
#include <string>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// Distance (m, positive outward) by which the next better theory moves the turning point at this frequency:
// from Kirchhoff to Mindlin, or from Mindlin to the elastic section; 0 for elastic. The taper is continued
// beyond its ends. Edges that are defined by amplitude move by the same distance within 3 %. On the 2 mm
// reference plate at 22.4 to 45 kHz, the distance is 10.7 to 14.9 mm from Kirchhoff to Mindlin and -0.3 to
// -0.1 mm from Mindlin to elastic. Empty for a membrane, for a plate with tension or simply supported sides,
// and if a table of half-widths ends before the turning point.
std::optional<double> shear_shift_m(const Surface& surface, double frequency_Hz);

struct TheoryChoice {
  PlateTheory theory = PlateTheory::kirchhoff;
  // distance between the boundaries by Kirchhoff and by the elastic section, at the frequency where it is
  // largest
  double shift_m = 0;
  std::string reason;  // why this theory was chosen: one sentence with numbers
};

// Chooses the simplest theory (Kirchhoff, Mindlin, elastic cross-section) that places the boundary within the
// tolerance of where the elastic theory places it, at all frequencies. Without a tolerance it chooses
// Mindlin, the best theory that all models solve, or Kirchhoff if shear moves the boundary by at most 0.05
// mm. On a surface to which only Kirchhoff's theory applies, it chooses Kirchhoff.
TheoryChoice choose_theory(const Surface& surface, std::span<const double> frequencies_Hz,
                           std::optional<double> tolerance_m);

}  // namespace turnpoint::physics

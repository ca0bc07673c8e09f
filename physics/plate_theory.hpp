#pragma once
// How far the choice of a plate's theory moves a boundary, and which theory is good enough.
#include <optional>
#include <span>
#include <string>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// Distance (m, outward positive) from this surface's turning point to the next better theory's at the same
// frequency, on the taper continued beyond its ends: from Kirchhoff's to Mindlin's, from Mindlin's to the
// elastic section's, 0 for elastic. An edge defined by amplitude moves as far within 3 %. On the 2 mm
// reference plate, 22.4 to 45 kHz: 10.7 to 14.9 mm from Kirchhoff to Mindlin, -0.3 to -0.1 mm from Mindlin to
// elastic. None for a membrane, a plate with tension or simply supported sides, or where a table of
// half-widths ends before.
std::optional<double> shear_shift_m(const Surface& surface, double frequency_Hz);

struct TheoryChoice {
  PlateTheory theory = PlateTheory::kirchhoff;
  double shift_m = 0;  // of Kirchhoff's boundary to the elastic section's, the largest over the frequencies
  std::string reason;  // one sentence, with numbers
};

// The simplest theory whose boundary is within the tolerance at all frequencies: Kirchhoff, Mindlin, or the
// elastic cross-section, which is also taken without a tolerance. Kirchhoff for a surface to which the others
// do not apply.
TheoryChoice choose_theory(const Surface& surface, std::span<const double> frequencies_Hz,
                           std::optional<double> tolerance_m);

}  // namespace turnpoint::physics

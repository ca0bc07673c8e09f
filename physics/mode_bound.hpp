#pragma once
// Bound for the difference between the one-mode field and the two-dimensional one, without solving the
// latter.
#include <optional>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// All for `mode` (or the exact first mode) against `modes`. Scaling from the wave front's curvature across
// the straight drive edge, constants measured on random surfaces (tests/physics/planner_test.cpp).
struct ModeBound {
  double shape = 0;       // of |v| with the last maximum at one, relative to the largest value
  double drive = 0;       // of |v| with v(0) at one, relative to the largest value
  double level_dB = 0;    // of the last maximum over the drive edge
  double equation_m = 0;  // of an edge's position: the one-mode equation of a curved or steep taper
  double drive_m = 0;     // the same: higher modes of the drive edge, a straight clamped end close by
  double position_m() const { return equation_m + drive_m; }
  double higher_modes = 0;  // share of `shape` that the drive edge's higher modes make
};

// `conditioning` is that of the first mode's v(0) (CentreLine::drive_conditioning); `last_peak_m` the mode's
// own last maximum, where it is known: loss draws it towards the drive edge and its higher modes.
ModeBound mode_bound(const Surface& surface, double frequency_Hz, double conditioning,
                     std::optional<double> last_peak_m);

// The same for the displacement of the higher modes at a position, relative to the drive edge's: they fall
// beyond their own turning points.
double higher_mode_decay(const Surface& surface, double frequency_Hz, double x_m);

}  // namespace turnpoint::physics

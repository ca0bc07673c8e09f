#pragma once
// Estimates what the model `mode` leaves out on membranes and simply supported plates, without solving for
// the two-dimensional field.
#include "physics/surface.hpp"

namespace turnpoint::physics {

// Effects of first order in the slope and the curvature of the sides. The wave fronts of the first mode are
// arcs that meet both sides at a right angle. Two things excite higher modes:
// - The drive edge is straight and cuts across the arcs, so the first mode alone does not have the shape of
//   the drive there. The higher modes make up the difference.
// - Where the slope of the sides changes, the curvature of the arcs changes too, and each mode turns partly
//   into the others. The way through another mode matters: it may reach a resonant mode that the first mode
//   excites only weakly by itself.
// A changing slope also shifts the phase of every mode. On curved sides, the effects are computed without the
// curvature, with it, and with twice the curvature, because one result may be small by chance. Each member
// holds the largest of the three results.
struct HigherModes {
  // sum of the largest |v| of each higher mode, divided by the largest |v| of the first mode
  double field = 0;
  // sum of |v| of the higher modes at `near_m`, divided by |v| of the first mode there
  double near = 0;
  // The first mode in the two-dimensional field with v(0) = 1 is that of the model `mode` with v(0) = 1,
  // times a complex factor: |ln|factor|| and |factor - 1|.
  double gain = 0, change = 0;
  // phase (rad) by which curved sides shift the first mode between the drive edge and its turning point,
  // times its standing wave at the drive edge, divided by its largest |v|
  double phase = 0;
  // factor by which resonance makes the higher modes on the surface larger than the drive edge alone would
  double resonance = 1;
};

// `near_m` is a position shortly before the turning point of the first mode.
HigherModes higher_modes(const Surface& surface, double frequency_Hz, double near_m);

// Natural logarithm of the factor by which the n-th symmetric mode, n = 1, 2, ..., decays from one position
// to another, where the strip is too narrow for it.
double ln_decay(const Surface& surface, double frequency_Hz, int n, double from_m, double to_m);

}  // namespace turnpoint::physics

#pragma once
// Bounds the difference between the one-mode field and the two-dimensional field, without solving for the
// two-dimensional field.
#include <optional>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// The error of every model that comes from the sides: rough ones are solved as smoother ones, and a simply
// supported plate with curved sides as a membrane (smooth_sides.hpp). The bounds are differences between
// three solutions of the one-mode equation, with loss: on the smoothed sides, on the given ones (taken twice,
// as a margin) and on the narrowed ones. Where higher modes propagate, the same is done for each of them. 0
// if the sides are straight or given by few points.
struct SideError {
  double position_m = 0;  // shift of any edge
  double shape = 0;       // error of |v|, relative to the last maximum
  double phase = 0;       // of the wave at the drive edge, relative to the standing wave there
  // error of |v| if v(0) is set to one, relative to the largest value
  double drive(double conditioning) const;
  double level_dB(double conditioning) const;
};
SideError side_error(const Surface& surface, double frequency_Hz);

// Bounds on the error of `mode` (or of the exact first mode) compared with `modes`. Their form follows from
// the curvature of the wave front at the straight drive edge. Their constants were measured on random
// surfaces (tests/physics/planner_test.cpp).
struct ModeBound {
  double shape = 0;     // error of |v| if the last maximum is set to one, relative to the largest value
  double drive = 0;     // error of |v| if v(0) is set to one, relative to the largest value
  double level_dB = 0;  // error of the ratio of |v| at the last maximum to |v(0)|
  // error of an edge's position on a curved or steep taper, caused by using the equation for one mode
  double equation_m = 0;
  // error of an edge's position, caused by higher modes from the drive edge and by a straight clamped end
  // nearby
  double drive_m = 0;
  double position_m() const { return equation_m + drive_m; }
  // factor by which resonance makes the higher modes on the surface larger than the drive edge alone would
  double resonance = 1;
  double steepest = 0;  // largest |W'| between the drive edge and the turning point
  // distance of the edge from the turning point towards the tip, divided by the Airy length of the decay
  // there
  double away = 0;
  SideError sides;  // what the above include because of the sides
};

// Computes the bounds. `conditioning` is CentreLine::drive_conditioning of the first mode. `last_peak_m` is
// the last maximum of the first mode, if known. It matters because loss moves it towards the drive edge,
// where higher modes are stronger. `edge_m` is the edge whose position is bounded: the farther a clamped
// plate's edge is from the turning point, the less is known of it. If empty, an edge at half of the last
// maximum is meant.
ModeBound mode_bound(const Surface& surface, double frequency_Hz, double conditioning,
                     std::optional<double> last_peak_m, std::optional<double> edge_m = {});

}  // namespace turnpoint::physics

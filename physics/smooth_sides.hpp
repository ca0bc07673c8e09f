#pragma once
// Replaces tabulated sides with close points by smoother ones that carry nearly the same wave. Needs Eigen.
#include "physics/surface.hpp"

namespace turnpoint::physics {

// The two-dimensional field is described by polynomials in x and eta = y/W(x). On sides that are rough within
// a half-width, such as measured ones, the field is smooth in y, but not in eta. So where points of a table
// are close together, cubics of 0.6 half-widths are fitted to it by least squares. Returns a table with fewer
// points and with slopes, which falls everywhere. It depends on the sides only, not on the frequency. A
// surface without close points, or with slopes already, is returned unchanged.
Surface smooth_sides(const Surface& surface);

// Returns `smooth`, the smoothed sides of `surface`, moved inwards at least as far as what they leave out
// shifts a wave. The roughness d(x) that is left out has the mean zero, but to second order it makes the
// strip narrower, by the mean of d |q| d with q the wavenumber of the roughness, and on a clamped plate by
// twice that: a field that is zero on the rough side is zero on a straight line further inside. On a simply
// supported plate it is (1 + nu)/2 times that, and the bending moment has a mean: the side resists rotation
// like a spring with M = C v_y and C = (1 - nu) (3 + nu)/2 times the mean of d |q|^3 d. This acts on the wave
// like a strip that is narrower by C D / (2 D k^2 + N). So does a curved side, of curvature kappa, with (1 -
// nu) kappa instead of C: zero moment means lap v = (1 - nu) kappa dv/dn there (Rayleigh, Theory of Sound,
// section 225), but such a plate is solved as a membrane. All are taken twice, as a margin.
Surface narrowed_sides(const Surface& surface, const Surface& smooth, double frequency_Hz);

}  // namespace turnpoint::physics

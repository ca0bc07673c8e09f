#pragma once
// The model `modes`, and `mode` of a clamped plate: the field as transverse functions times finite elements
// along x.
#include <functional>
#include <memory>

#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// The resolution of the field. The defaults agree with the exact two-dimensional field to 1e-5 or better.
struct ModalResolution {
  int degree = 7;           // degree of the polynomials along x
  double radians = 2.5;     // phase (wavenumber times length) per element
  int spare_functions = 3;  // number of transverse functions beyond those that can propagate
  // Displacement of the drive edge as a function of eta = y/W in [0, 1]; if empty, the surface's `drive` is
  // used. With the drive displacement of an exactly known field, the solution can be compared with that
  // field.
  std::function<double(double)> drive;
  // which transverse functions are used
  enum class Across { polynomials, cut_off_shape } across = Across::polynomials;
};

// Galerkin solution of (plate theories mindlin and elastic: see section_basis.hpp; otherwise membrane or
// simply supported plate) lap v + k^2 v = 0, or (clamped plate) D lap^2 v - N lap v = (D k^4 + N k^2) v, k
// lossy, on |y| < W(x), 0 < x < length: v = 0 (and no slope, clamped) on the sides and the far end, v = drive
// shape (and no slope) at x = 0. Eliminated from the tip to the drive edge, so that the tail keeps its
// relative accuracy; beyond e^-45 of the last lobe the one-mode decay continues it. The centre line has v(0)
// = 1. Source: Galerkin's method in the coordinates (x, y/W(x)).
std::unique_ptr<CentreLine> make_modal_line(const Surface& surface, double frequency_Hz, Losses losses,
                                            const ModalResolution& resolution);

}  // namespace turnpoint::physics

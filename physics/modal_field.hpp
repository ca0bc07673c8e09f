#pragma once
// `modes`, and `mode` of a clamped plate: the field as transverse functions times elements along x.
#include <functional>
#include <memory>

#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// How the field is resolved. The defaults give 1e-5 or better of the two-dimensional field.
struct ModalResolution {
  int degree = 7;           // of the polynomials along x
  double radians = 2.5;     // of wavenumber per element
  int spare_functions = 3;  // transverse functions beyond those that can propagate
  // Displacement of the drive edge against eta = y/W in [0, 1]; empty: by the surface's `drive`. The field is
  // that of this displacement, so that an exact field can be driven and compared.
  std::function<double(double)> drive;
  enum class Across { polynomials, cut_off_shape } across = Across::polynomials;  // transverse functions
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

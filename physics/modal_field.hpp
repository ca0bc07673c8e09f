#pragma once
// Solves the model `modes` and, for a clamped plate, the model `mode`. The field is a sum of transverse
// functions times finite elements along x.
#include <functional>
#include <memory>
#include <optional>

#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// The resolution of the field. With the default values, the field agrees with the exact two-dimensional field
// to 1e-5 or better.
struct ModalResolution {
  // Degree of the polynomials along x. If empty: 7; for a thick plate 5, because its solution takes long.
  // With degree 5 it agrees with a finer solution to 1e-4.
  std::optional<int> degree;
  double radians = 2.5;     // phase (wavenumber times length, in radians) that one element spans
  int spare_functions = 3;  // number of transverse functions beyond those that follow waves across the strip
  // Displacement of the drive edge as a function of eta = y/W in [0, 1]. If empty, the surface's `drive` is
  // used. Tests use it to prescribe the drive edge of a field that is known exactly.
  std::function<double(double)> drive;
  // the transverse functions: polynomials (model `modes`), or the shape at the cut-off (model `mode`)
  enum class Across { polynomials, cut_off_shape } across = Across::polynomials;
};

// Solves for the field on |y| < W(x), 0 < x < length, by Galerkin's method in the coordinates (x, y/W(x)).
// The equation of a membrane or a simply supported plate is lap v + k^2 v = 0; that of a clamped plate is D
// lap^2 v - N lap v = (D k^4 + N k^2) v. The wavenumber k includes loss. (For the plate theories mindlin and
// elastic see section_basis.hpp.) On the sides and at the far end v = 0; at x = 0 v has the drive's shape. A
// clamped plate also has zero slope at all these edges. The unknowns are eliminated from the tip to the drive
// edge, so that the decaying tail keeps its relative accuracy. Where the field is below e^-45 of the last
// lobe, the one-mode decay continues it. The result is scaled to v(0) = 1.
std::unique_ptr<CentreLine> make_modal_line(const Surface& surface, double frequency_Hz, Losses losses,
                                            const ModalResolution& resolution);

// Throws std::domain_error if make_modal_line() at the default resolution would, because the field has too
// many waves across the surface.
void require_modal_line(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

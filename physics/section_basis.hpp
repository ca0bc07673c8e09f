#pragma once
// Basis functions over the cross-section of a thick clamped strip. The strip's motion is a sum of these
// functions, with coefficients that depend on x. Needs Eigen.
#include <Eigen/Core>
#include <array>

#include "physics/surface.hpp"
#include "physics/transverse_basis.hpp"

namespace turnpoint::physics {

// The motion is u(x, y, z) = sum f_i(x) U_i(y / W(x), z). A function U has several components: deflection and
// rotations (Mindlin), or three displacements (elastic). The strain of one term is f' X + f (-W'/W R + Y/W +
// Z). X contains the strains that come from derivatives by x, computed from U; R contains the same strains,
// computed from eta dU/deta. Y contains the strains that come from derivatives by y, and Z those without a
// derivative by x or y. Integrals are over eta in [0, 1], in SI units, for half of the strip.
struct SectionBasis {
  using Matrix = Eigen::MatrixXd;
  enum Part { along, stretch, across, local };  // the strains X, R, Y and Z
  // integrals of part i (X, R, Y or Z) of function a times part j of function b
  std::array<std::array<Matrix, 4>, 4> stiff;
  Matrix mass;
  Eigen::VectorXd centre;  // deflection of the centre line by each function
  // motion of the drive edge: the cut-off shape that belongs to its half-width, without the motion along x
  Eigen::VectorXd drive;
  Eigen::Index count() const { return mass.rows(); }
};

// Makes polynomials of eta for the deflection and both rotations of a Mindlin plate. They can describe its
// full two-dimensional field. The parity is that of the deflection. Odd fields have no drive.
SectionBasis mindlin_polynomials(const Surface& surface, int each, Parity parity = Parity::even);

// Makes functions by Kantorovich's method from three shapes: the cut-off shapes at two half-widths, and the
// shape of the travelling wave at the drive edge. Each shape gives one function for the motion in the
// cross-section and two for the motion along x. Together they describe the propagating and the evanescent
// wave of the strip. At the turning point they are exact to first order in k_x^2.
SectionBasis section_shapes(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

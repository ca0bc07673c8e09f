#pragma once
// Functions over the cross-section of a thick clamped strip, in which its motion is expanded. Needs Eigen.
#include <Eigen/Dense>
#include <array>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// u(x, y, z) = sum f_i(x) U_i(y / W(x), z), all components of the motion at once: deflection and rotations
// (Mindlin), displacements (elastic). The strain of a term is f' X + f (-W'/W R + Y/W + Z): X from U by d/dx,
// R the same from eta dU/deta, Y from dU/deta by d/dy, Z from what has no derivative in x or y. Integrals
// over eta in [0, 1], SI units, for half the strip.
struct SectionBasis {
  using Matrix = Eigen::MatrixXd;
  enum Part { along, stretch, across, local };  // X, R, Y, Z
  std::array<std::array<Matrix, 4>, 4> stiff;   // part i of function a with part j of function b
  Matrix mass;
  Eigen::VectorXd centre;  // deflection of the centre line
  Eigen::VectorXd drive;   // the drive edge's motion, without motion along x: the shape of
                           // its own cut-off
  Eigen::Index count() const { return mass.rows(); }
};

// Polynomials of eta for deflection and both rotations of Mindlin's plate: its two-dimensional field.
SectionBasis mindlin_polynomials(const Surface& surface, int each);

// The cut-off's shapes at three half-widths: for each the motion in the cross-section, and two for the motion
// along x that goes with it. It holds both of the strip's branches, propagating and evanescent, and is exact
// at the turning point to first order in k_x^2. Source: Kantorovich's method.
SectionBasis section_shapes(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

#pragma once
// Functions over the cross-section of a thick clamped strip, with which its motion is described. Needs Eigen.
#include <Eigen/Dense>
#include <array>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// The motion is u(x, y, z) = sum f_i(x) U_i(y / W(x), z), with all its components at once: deflection and
// rotations (Mindlin) or displacements (elastic). The strain of one term is f' X + f (-W'/W R + Y/W + Z): X
// comes from the derivative d/dx of U, R in the same way from eta dU/deta, Y from d/dy of U, and Z from parts
// without a derivative in x or y. Integrals are over eta in [0, 1], in SI units, for half of the strip.
struct SectionBasis {
  using Matrix = Eigen::MatrixXd;
  enum Part { along, stretch, across, local };  // X, R, Y, Z
  // integrals of part i of function a times part j of function b
  std::array<std::array<Matrix, 4>, 4> stiff;
  Matrix mass;
  Eigen::VectorXd centre;  // deflection of the centre line by each function
  Eigen::VectorXd drive;   // the drive edge's motion, without motion along x: the shape of
                           // its own cut-off
  Eigen::Index count() const { return mass.rows(); }
};

// Makes polynomials of eta for deflection and both rotations of Mindlin's plate, which describe its
// two-dimensional field.
SectionBasis mindlin_polynomials(const Surface& surface, int each);

// Makes functions from the cut-off's shapes at three half-widths and the travelling wave's at the drive edge:
// for each the motion in the cross-section, and two functions for the motion along x that belongs to it. They
// describe both of the strip's branches, propagating and evanescent, and are exact at the turning point to
// first order in k_x^2. Source: Kantorovich's method.
SectionBasis section_shapes(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

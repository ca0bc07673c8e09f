#pragma once
// Finite elements over the upper right quarter of a clamped strip's cross-section. Needs Eigen.
#include <Eigen/Dense>

namespace turnpoint::physics {

// Unit half-width, density and shear modulus; u = (i k A, b, c). Functions: products of polynomials, by
// elements in y that are finer towards the clamp, where the stress at the free face's corner is singular.
// A and b are odd in z, c even; b is odd in y, A and c even; all vanish at y = 1.
struct SectionElements {
  SectionElements(double thickness_per_half_width, double poisson);

  Eigen::Index size() const { return along_mass.rows(); }
  // The equations of A, then those of (b, c), for exp(-i k x), k^2 = L:
  //   (shear + (lame + 2) L along_mass - omega^2 along_mass) A + coupling (b, c) = 0
  //   (plane + L mass - omega^2 mass) (b, c) + L coupling^T A = 0
  Eigen::MatrixXd shear, along_mass, coupling, plane, mass;
  double lame;  // lambda / G
};

// The cut-off's omega and its shape (b, c), by inverse iteration.
struct SectionCutOff {
  double omega;
  Eigen::VectorXd shape;
};
SectionCutOff section_cut_off(const SectionElements& section);

}  // namespace turnpoint::physics

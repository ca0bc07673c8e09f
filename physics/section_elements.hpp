#pragma once
// Finite elements for the upper right quarter of a clamped strip's cross-section. Needs Eigen.
#include <Eigen/Dense>

namespace turnpoint::physics {

// The waves exp(-i k x) of a uniform strip with k^2 = L. Their motion is i k A along x and B in the
// cross-section:
//   (shear + L along - omega^2 along_mass) A + coupling B = 0
//   (plane + L cross - omega^2 mass) B + L coupling^T A = 0
// `stretching` couples A with the motion eta dB/deta, which a taper adds to the derivative d/dx of B (y = eta
// W(x)).
struct SectionPencil {
  Eigen::MatrixXd shear, along, along_mass, coupling, plane, cross, mass, stretching;
};

// The lowest cut-off (L = 0) and its motion B, found by inverse iteration.
struct SectionCutOff {
  double omega;
  Eigen::VectorXd shape;
};
SectionCutOff section_cut_off(const SectionPencil& pencil);

// The motion at the cut-off: B; A, which follows it in proportion to its derivative along x; and the A that
// follows its stretching, without which a thin section would be too stiff: its normals could not stay normal
// to a surface that narrows. One column each.
struct SectionShapes {
  Eigen::VectorXd cross, along, stretched;
};
SectionShapes section_shapes_of(const SectionPencil& pencil);

// The same for the wave of `omega` whose k^2 is nearest to `along2`.
SectionShapes section_shapes_of(const SectionPencil& pencil, double omega, double along2);

// Functions of one coordinate at quadrature points, with one row per function and one column per point.
struct LineFunctions {
  Eigen::MatrixXd even, even_slope, odd, odd_slope;
  Eigen::VectorXd at, weight;
  Eigen::VectorXd even_start;  // values of the even functions at 0
};

// Unit half-width, density and shear modulus; displacements (i k A, b, c), B = (b, c). Functions: products of
// polynomials, by elements in y that are finer towards the clamp, where the stress at the free face's corner
// is singular. A and b are odd in z, c even; b is odd in y, A and c even; all vanish at y = 1. Ordered by y,
// then z.
struct SectionElements {
  // `layer` is the depth of the finer elements; sections with the same layer have the same functions of y.
  SectionElements(double thickness_per_half_width, double poisson, double layer);
  SectionElements(double thickness_per_half_width, double poisson);

  // Returns, as a motion B, how the section thickens if it is stretched by A. Without this thickening,
  // bending along x would be too stiff.
  Eigen::VectorXd thickening(const Eigen::VectorXd& along) const;

  LineFunctions across, through;
  SectionPencil pencil;
  double lame;  // Lame's constant divided by the shear modulus, lambda / G
};

}  // namespace turnpoint::physics

#pragma once
// Finite elements for one quarter (y > 0, z > 0) of a clamped strip's cross-section. Needs Eigen.
#include <Eigen/Core>

namespace turnpoint::physics {

// Matrices of the equations for waves exp(-i k x) in a uniform strip, with L = k^2. The motion is i k A along
// x and B in the cross-section:
//   (shear + L along - omega^2 along_mass) A + coupling B = 0
//   (plane + L cross - omega^2 mass) B + L coupling^T A = 0
// `stretching` couples A with eta dB/deta. On a taper y = eta W(x), so that the derivative d/dx of B contains
// this term.
struct SectionPencil {
  Eigen::MatrixXd shear, along, along_mass, coupling, plane, cross, mass, stretching;
};

// The lowest cut-off frequency of the cross-section, where L = 0, and the motion B at this frequency. Found
// by inverse iteration.
struct SectionCutOff {
  double omega;
  Eigen::VectorXd shape;
};
SectionCutOff section_cut_off(const SectionPencil& pencil);

// Motions of the section at the cut-off. `cross` is the motion B in the cross-section. `along` is the motion
// A along x that B causes where its amplitude changes along x. `stretched` is the motion A that B causes
// where the strip narrows. Without `stretched`, a thin section would be too stiff, because its normals could
// not stay normal to the bent surface.
struct SectionShapes {
  Eigen::VectorXd cross, along, stretched;
};
SectionShapes section_shapes_of(const SectionPencil& pencil);

// The three motions of SectionShapes for the wave at `omega` whose k^2 is nearest to `along2`.
SectionShapes section_shapes_of(const SectionPencil& pencil, double omega, double along2);

// Functions of one coordinate at quadrature points, with one row per function and one column per point.
struct LineFunctions {
  Eigen::MatrixXd even, even_slope, odd, odd_slope;
  Eigen::VectorXd at, weight;
  Eigen::VectorXd even_start;  // values of the even functions at 0
};

// The finite elements for one ratio h/W and one Poisson's ratio; half-width, density and shear modulus are 1.
// The displacements are (i k A, b, c), and B = (b, c). The functions are products of a function of y and a
// function of z, ordered by y, then by z. Elements in y are finer near the clamp, because the stress is
// singular at the corner between clamp and free face. A and b are odd in z, and c is even; b is odd in y, and
// A and c are even. All functions vanish at y = 1.
struct SectionElements {
  // `layer` is the width in y of the zone of finer elements. Two sections with the same layer have the same
  // functions of y.
  SectionElements(double thickness_per_half_width, double poisson, double layer);
  SectionElements(double thickness_per_half_width, double poisson);

  // Returns the motion B with which the section thickens or thins when A stretches it. Without this motion,
  // bending along x would be too stiff.
  Eigen::VectorXd thickening(const Eigen::VectorXd& along) const;

  LineFunctions across, through;
  SectionPencil pencil;
  double lame;  // Lame's constant lambda divided by the shear modulus G
};

}  // namespace turnpoint::physics

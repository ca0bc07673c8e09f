#pragma once
// Solves for the field of a thick plate, which is a sum of functions over the cross-section times finite
// elements along x.
#include <complex>
#include <vector>

#include "physics/modal_setup.hpp"
#include "physics/section_basis.hpp"

namespace turnpoint::physics {

// Solves the equation of the surface's plate theory by Galerkin's method and computes the centre line of each
// element. `resolution.across` selects the functions: the cut-off shapes (model `mode`), or polynomials
// (model `modes`). Polynomials exist for Mindlin only; for elastic they throw std::domain_error. Loss
// multiplies omega^2 by (1 - i/2Q)^4, which corresponds to k (1 - i/2Q) for a thin plate.
void solve_section_elements(const Surface& surface, double frequency_Hz, Losses losses,
                            const ModalResolution& resolution, const ModalSetup& setup,
                            std::vector<ModalElement>& elements);

// The symmetric matrix of an element, stiffness - omega^2 mass. Its unknowns are ordered by basis function
// along x, then by function of the section.
struct SectionElement {
  Eigen::MatrixXd real, imaginary;
};

class SectionAssembler {
 public:
  SectionAssembler(const SectionBasis& section, const ModalSetup& setup, std::complex<double> omega2);
  SectionElement element(const ModalElement& element) const;

 private:
  const ModalSetup& setup_;
  std::complex<double> omega2_;
  Eigen::Index n_;  // number of functions of the section
  // the matrices over the section of which each block of an element is a sum, one per column; the last is the
  // mass
  Eigen::MatrixXd terms_;
};

}  // namespace turnpoint::physics

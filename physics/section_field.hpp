#pragma once
// Solves for the field of a thick plate, which is a sum of functions over the cross-section times finite
// elements along x.
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

// The symmetric matrices of an element. The field obeys stiffness - omega^2 mass. Unknowns are ordered by
// basis function along x, then by function of the section.
struct SectionElement {
  Eigen::MatrixXd stiffness, mass;
};
SectionElement section_element(const SectionBasis& section, const ModalSetup& setup,
                               const ModalElement& element);

}  // namespace turnpoint::physics

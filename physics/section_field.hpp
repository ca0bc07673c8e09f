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

// The symmetric matrix of an element for the squared angular frequency `omega2`. Unknowns are ordered by
// basis function along x, then by function of the section.
Eigen::MatrixXcd section_element_matrix(const SectionBasis& section, const ModalSetup& setup,
                                        std::complex<double> omega2, const ModalElement& element);

}  // namespace turnpoint::physics

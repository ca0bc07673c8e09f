#pragma once
// The field of a thick plate: functions over the cross-section times finite elements along x.
#include <vector>

#include "physics/modal_setup.hpp"

namespace turnpoint::physics {

// Galerkin solution of the surface's plate theory with the functions that `resolution.across` selects: the
// shapes of the cut-off (`mode`), or polynomials (`modes`, only for Mindlin; std::domain_error for elastic).
// Computes the centre line of each element. Loss multiplies omega^2 by (1 - i/2Q)^4, which corresponds to k
// (1 - i/2Q) of a thin plate.
void solve_section_elements(const Surface& surface, double frequency_Hz, Losses losses,
                            const ModalResolution& resolution, const ModalSetup& setup,
                            std::vector<ModalElement>& elements);

}  // namespace turnpoint::physics

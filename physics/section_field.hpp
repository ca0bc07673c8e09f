#pragma once
// A thick plate's field: functions over the cross-section times elements along x.
#include <vector>

#include "physics/modal_setup.hpp"

namespace turnpoint::physics {

// Galerkin solution of the surface's plate theory with the functions that `resolution.across` names: the
// shapes of the cut-off (`mode`), or polynomials (`modes`, Mindlin only; std::domain_error for elastic).
// Fills the centre line of each element. Modulus lossy by (1 - i/2Q)^4 of omega^2, as k (1 - i/2Q) of a thin
// plate.
void solve_section_elements(const Surface& surface, double frequency_Hz, Losses losses,
                            const ModalResolution& resolution, const ModalSetup& setup,
                            std::vector<ModalElement>& elements);

}  // namespace turnpoint::physics

#pragma once
// The response of a clamped plate to a force, by the elements that solve its `mode`.
#include <complex>
#include <vector>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// G(x, x) in m/N at each position: displacement of the centre line there per unit of a force on it, drive
// edge held, by the one-shape mode with loss. Each element is seen between what lies beyond it and what lies
// before it (their stiffnesses, eliminated from the tip and from the drive edge). Right to 1e-3: the force's
// jump lies inside an element. x_m in [0, length_m].
std::vector<std::complex<double>> plate_receptance_m_per_N(const Surface& surface, double frequency_Hz,
                                                           const std::vector<double>& x_m);

}  // namespace turnpoint::physics

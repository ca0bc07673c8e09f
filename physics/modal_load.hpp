#pragma once
// Computes how a clamped plate responds to a force, with the finite elements that also solve its model
// `mode`.
#include <complex>
#include <vector>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// The receptance G(x, x) in m/N at each position x_m in [0, length_m]: a force acts on the centre line at x,
// and G is the displacement at x divided by this force. The drive edge is held, and the transverse shape is
// the one of `mode`, with loss. Each element is loaded by the stiffness of all elements before and beyond it,
// which are eliminated from the drive edge and from the tip. The relative error is about 1e-3, because the
// force makes the shear jump inside an element.
std::vector<std::complex<double>> plate_receptance_m_per_N(const Surface& surface, double frequency_Hz,
                                                           const std::vector<double>& x_m);

}  // namespace turnpoint::physics

#pragma once
// `uniform`: Langer & Olver's uniform Airy approximation of the flux-corrected equation.
#include <memory>

#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// g = (zeta/p)^(1/4) Ai(-zeta), (2/3) zeta^(3/2) = integral of sqrt(p) from x to the turning point (Olver
// 1974, ch. 11), v = g W^-1/2. On a linear taper Langer's 1/4 enters p, so that the apex is right, and the
// integral is closed; elsewhere it is a Gauss rule after removing the square root. Lossless. Throws
// std::domain_error when the turning point is not on the taper, or for clamped plates, which have no such
// equation.
std::unique_ptr<CentreLine> make_uniform_line(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

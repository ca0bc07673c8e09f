#pragma once
// The model `uniform`: Langer & Olver's uniform Airy approximation of the flux-corrected equation.
#include <memory>

#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// The profile v = g W^-1/2 with g = (zeta/p)^(1/4) Ai(-zeta) and (2/3) zeta^(3/2) = integral of sqrt(p) from
// x to the turning point (Olver 1974, ch. 11). Loss is left out. On a linear taper p includes Langer's
// correction 1/4, which makes the solution right at the apex, and the integral has a closed form. On other
// tapers a Gauss rule computes the integral; a substitution first removes the square root at the turning
// point. Throws std::domain_error if the turning point is not on the taper, and for clamped plates, to which
// this equation does not apply.
std::unique_ptr<CentreLine> make_uniform_line(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

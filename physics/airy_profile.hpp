#pragma once
// The model `airy`: the displacement profile in closed form by eqs. 20-22 of the 1998 paper (named in
// physics/README.md).
#include <memory>

#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// The profile Ai(k0 (x - x0)), without loss. x0 is the turning point, where p = k^2 - (pi / 2W)^2 is zero (k:
// wavenumber, W: half-width); k0^3 = -dp/dx there. On a linear taper of slope d this is the paper's k0^3 = (4
// d omega^3/pi)(rho/T)^(3/2). Throws std::domain_error if there is no turning point on the taper or its
// continuation.
std::unique_ptr<CentreLine> make_airy_line(const Surface& surface, double frequency_Hz);

// The turning point x0 and the factor k0 of the profile Ai(k0 (x - x0)).
struct AiryScale {
  double turning_point_m;
  double k0_per_m;
};
AiryScale airy_scale(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

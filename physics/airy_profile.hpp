#pragma once
// `airy`: the seed's closed profile (eqs. 20-22).
#include <memory>

#include "physics/centre_line.hpp"

namespace turnpoint::physics {

// Ai(k0 (x - x0)), k0^3 = -dp/dx at the turning point x0 of p = k^2 - (local cut-off)^2: the seed's
// (4 d omega^3/pi)(rho/T)^(3/2) on a linear taper. Lossless. Throws std::domain_error without a turning point
// on the taper or its continuation.
std::unique_ptr<CentreLine> make_airy_line(const Surface& surface, double frequency_Hz);

// x0 and k0 of the above.
struct AiryScale {
  double turning_point_m;
  double k0_per_m;
};
AiryScale airy_scale(const Surface& surface, double frequency_Hz);

}  // namespace turnpoint::physics

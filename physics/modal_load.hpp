#pragma once
// The two-dimensional field under a pressure over a disc, by the elements that solve `modes`.
#include <complex>
#include <vector>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// A disc whose centre is `beside_m` from the centre line.
struct Disc {
  double radius_m;
  double beside_m;
};

// Means over a disc. Where it is beyond the strip, the surface does not move.
struct DiscResponse {
  std::complex<double> unloaded;  // displacement of the free surface, with v(0) = 1
  // displacement per unit of a force spread evenly over the disc, with the drive edge held
  std::complex<double> receptance_m_per_N;
};

// For each position in [0, length_m]. The elements' unknowns are eliminated once; one position then takes
// 0.1 ms. Loss is in the stiffness, which is divided by (1 - i/2Q)^4 (plate) or (1 - i/2Q)^2 (membrane).
// Plate theory elastic: by Mindlin's.
std::vector<DiscResponse> disc_responses(const Surface& surface, double frequency_Hz, const Disc& disc,
                                         const std::vector<double>& x_m);

}  // namespace turnpoint::physics

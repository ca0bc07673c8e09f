#pragma once
// Computes the two-dimensional field under a pressure on a disc, with the finite elements of the model
// `modes`.
#include <complex>
#include <vector>

#include "physics/surface.hpp"

namespace turnpoint::physics {

// A disc-shaped area under pressure. Its centre is `beside_m` from the centre line of the surface.
struct Disc {
  double radius_m;
  double beside_m;
};

// Two averages over the area of a disc. Where the disc extends beyond the sides of the strip, the
// displacement counts as 0.
struct DiscResponse {
  std::complex<double> unloaded;  // displacement without the force, with v(0) = 1
  // displacement per unit of a force spread evenly over the disc, with the drive edge held
  std::complex<double> receptance_m_per_N;
};

// Computes the averages over a disc at each of the positions x_m, which lie in [0, length_m]. The elements'
// unknowns are eliminated only once, so that each position takes 0.1 ms. Loss makes the stiffness complex: it
// is divided by the factor of Dispersion::loss to the power 4 (plate) or 2 (membrane). PlateTheory::elastic
// is replaced by Mindlin's theory.
std::vector<DiscResponse> disc_responses(const Surface& surface, double frequency_Hz, const Disc& disc,
                                         const std::vector<double>& x_m);

}  // namespace turnpoint::physics

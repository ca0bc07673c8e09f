#pragma once
// The effect of a finger on the surface's vibration.
#include <complex>
#include <optional>
#include <vector>

#include "physics/edge.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics {

// A fingertip: a mechanical impedance, force divided by velocity with exp(+i omega t), that presses evenly on
// a disc. At ultrasonic frequencies fingertips are of the order of 55 N s/m, and differ between people (J.
// Monnoyer, E. Diaz, C. Bourdin, M. Wiertlewski, World Haptics 2017); measure it for your own study.
struct Finger {
  std::complex<double> impedance_Ns_per_m{55, 0};
  double contact_radius_m = 4e-3;
  double beside_m = 0;  // distance of the disc's centre from the centre line
};

// Means over the finger's disc, with the drive edge's motion unchanged.
struct FingerLoad {
  double x_m = 0;
  std::complex<double> unloaded;           // displacement of the free surface, with v(0) = 1
  std::complex<double> loaded;             // displacement under the finger, unloaded / (1 + Z mobility)
  std::complex<double> mobility_m_per_Ns;  // velocity of the free surface per unit of force on the disc

  // Fraction of the amplitude that remains under the finger.
  double share(const Finger& finger) const {
    return 1 / std::abs(1.0 + finger.impedance_Ns_per_m * mobility_m_per_Ns);
  }
};

// The surface under a finger at each position, by the two-dimensional field of `modes` (plate theory elastic:
// by Mindlin's). The share agrees with independent finite elements within `finger_share_bound` of itself, on
// the centre line and 3 mm beside it, and for impedances with phases of -60 to 60 degrees. Throws
// std::invalid_argument for a position beyond the surface, or a disc without radius.
std::vector<FingerLoad> finger_load(const Surface& surface, double frequency_Hz,
                                    const std::vector<double>& x_m, const Finger& finger);
inline constexpr double finger_share_bound = 0.02;

// Distance (m, positive towards the tip) from the free surface's edge to the edge that a moving finger feels,
// that is, the same feature of |loaded| as a function of position. Empty if either has no such edge. Only for
// percent and peak edges.
std::optional<double> finger_edge_shift_m(const Surface& surface, double frequency_Hz, const Edge& edge,
                                          const Finger& finger);

}  // namespace turnpoint::physics

#pragma once
// The effect of a finger on the surface's vibration.
#include <complex>
#include <optional>
#include <span>
#include <vector>

#include "physics/edge.hpp"
#include "physics/surface.hpp"

namespace turnpoint::physics {

// A fingertip, modelled as a mechanical impedance (force divided by velocity, with exp(+i omega t)) that
// presses evenly on a disc. At ultrasonic frequencies the impedance of fingertips is of the order of 55 N s/m
// and differs between people (J. Monnoyer, E. Diaz, C. Bourdin, M. Wiertlewski, World Haptics 2017). Measure
// it for your own study.
struct Finger {
  std::complex<double> impedance_Ns_per_m{55, 0};
  double contact_radius_m = 4e-3;
  double beside_m = 0;  // distance of the disc's centre from the centre line
};

// The effect of a finger at one position. All displacements are means over the disc under the finger. The
// motion of the drive edge is the same with and without the finger.
struct FingerLoad {
  double x_m = 0;
  std::complex<double> unloaded;  // displacement of the free surface, with v(0) = 1
  std::complex<double> loaded;    // displacement under the finger of impedance Z: unloaded / (1 + Z mobility)
  std::complex<double> mobility_m_per_Ns;  // velocity of the free surface per unit of force on the disc

  // Displacement under a finger of another impedance but with the same contact.
  std::complex<double> under(const Finger& finger) const {
    return unloaded / (1.0 + finger.impedance_Ns_per_m * mobility_m_per_Ns);
  }
  // Fraction of the amplitude that remains under the finger.
  double share(const Finger& finger) const {
    return 1 / std::abs(1.0 + finger.impedance_Ns_per_m * mobility_m_per_Ns);
  }
};

// The load of a finger at each position. It is computed from the two-dimensional field of Model::modes, with
// the surface's own plate theory or, if that is `elastic`, with Mindlin's theory. The fraction returned by
// share() agrees with independent finite elements within the relative error `finger_share_bound`, on the
// centre line and 3 mm beside it, and for impedances with phases of -60 to 60 degrees. Throws
// std::invalid_argument for a position beyond the surface, or a disc without radius.
std::vector<FingerLoad> finger_load(const Surface& surface, double frequency_Hz,
                                    const std::vector<double>& x_m, const Finger& finger);
inline constexpr double finger_share_bound = 0.02;

// Distance (m, positive towards the tip) from the free surface's edge to the edge that a moving finger feels.
// The felt edge is the same feature, but of the displacement under the finger as a function of its position.
// `sweep` are the loads at finger_sweep_m(), which are the same for fingers that differ only in impedance.
// Empty if either edge does not exist. Only for percent and peak edges.
std::vector<double> finger_sweep_m(const Surface& surface);
std::optional<double> finger_edge_shift_m(std::span<const FingerLoad> sweep, const Edge& edge,
                                          const Finger& finger);

}  // namespace turnpoint::physics

#pragma once
// The effect of a finger on the surface's vibration: a point impedance on the first transverse mode.
#include <complex>
#include <optional>
#include <vector>

#include "physics/edge.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

// Mechanical impedance of a fingertip on the surface in N s/m: force divided by velocity, with exp(+i omega
// t). Published magnitudes at ultrasonic frequencies are about 55 N s/m, mostly viscous (Wiertlewski &
// Colgate 2015); measure it for your own study.
struct Finger {
  std::complex<double> impedance_Ns_per_m{55, 0};
};

struct FingerLoad {
  double x_m = 0;
  std::complex<double> unloaded;  // v(x) of the free surface, with v(0) = 1
  // v(x) under the finger, with the drive edge's motion unchanged: v / (1 + i omega Z G(x, x))
  std::complex<double> loaded;
  double strip_impedance_Ns_per_m = 0;  // the impedance of the surface at x, |1 / (omega G(x, x))|
};

// Displacement under a finger at each position, by `mode` with loss. G is the response at x to a unit force
// that is distributed over the width like the mode; it is computed from the two solutions that vanish at the
// tip and at the drive edge, for a clamped plate from its finite elements. Throws std::domain_error for
// plates with simply supported sides.
std::vector<FingerLoad> finger_load(const Surface& surface, double frequency_Hz,
                                    const std::vector<double>& x_m, const Finger& finger);

// Distance (m, positive towards the tip) from the free surface's edge to the edge that a moving finger feels,
// that is, the same feature of |loaded| as a function of position. Empty if either has no such edge. Only for
// percent and peak edges.
std::optional<double> finger_edge_shift_m(const Surface& surface, double frequency_Hz, const Edge& edge,
                                          const Finger& finger);

}  // namespace turnpoint::physics

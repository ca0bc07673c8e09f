#pragma once
// The effect of a finger on the surface's vibration: a point impedance on the first transverse mode.
#include <complex>
#include <optional>
#include <vector>

#include "physics/edge.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

// Mechanical impedance of a fingertip pressed on the surface, N s/m, convention exp(+i omega t): force =
// impedance times velocity. Published magnitudes at ultrasonic frequencies are of order 55 N s/m, mostly
// viscous (Wiertlewski & Colgate 2015); measure it for the study at hand.
struct Finger {
  std::complex<double> impedance_Ns_per_m{55, 0};
};

struct FingerLoad {
  double x_m = 0;
  std::complex<double> unloaded;        // v(x) of the free surface, v(0) = 1
  std::complex<double> loaded;          // v(x) under the finger, drive edge held: v / (1 + i omega Z G(x, x))
  double strip_impedance_Ns_per_m = 0;  // |1 / (omega G(x, x))|: the impedance of the surface at x
};

// Loaded displacement under a finger at each position, by `mode` with loss. G is the response at x to a unit
// force shared out like the mode over the width, from the two solutions that vanish at the tip and at the
// drive edge; of a clamped plate from its elements. Throws std::domain_error for plates with simply supported
// sides.
std::vector<FingerLoad> finger_load(const Surface& surface, double frequency_Hz,
                                    const std::vector<double>& x_m, const Finger& finger);

// Distance of the edge that a moving finger feels from that of the free surface (m, positive towards the
// tip): the same feature of |loaded| as a function of position. Empty if either has no such edge. Percent and
// peak edges only.
std::optional<double> finger_edge_shift_m(const Surface& surface, double frequency_Hz, const Edge& edge,
                                          const Finger& finger);

}  // namespace turnpoint::physics

#pragma once
#include <array>

#include "station/plant/setup.hpp"

namespace turnpoint::plant {

/// Forces on cells a, b and lateral (N).
using CellForces = std::array<double, 3>;

/// The forces of a load on the three cells; see Cells.
CellForces forces_on(const Cells& cells, const Load& load);

/// A second-order low-pass with resonance: unit gain at rest, 1 / (1 - r^2 + 2 i damping r) at r times its
/// own frequency. Integrated by the trapezoidal rule.
class Resonance {
 public:
  Resonance(double frequency_Hz, double damping, double rate_Hz);
  double step(double input);

 private:
  double g_, k_, a1_;
  double band_ = 0, low_ = 0;
};

/// The cells with their resonances, crosstalk, zero and drift: from forces to readings, frame by frame (N).
class CellReadings {
 public:
  CellReadings(const Cells& cells, double rate_Hz);
  /// `warmth_K`: temperature above that for which zero_N holds.
  CellForces step(const CellForces& forces, double warmth_K);

 private:
  Cells cells_;
  std::array<Resonance, 3> resonances_;
};

}  // namespace turnpoint::plant

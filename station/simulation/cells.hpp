#pragma once
#include <array>

#include "station/simulation/setup.hpp"

namespace turnpoint::simulation {

/// Forces on the cells a, b and lateral, in that order (N).
using CellForces = std::array<double, 3>;

/// The forces that a load exerts on the three cells; see the formulas at Cells.
CellForces forces_on(const Cells& cells, const Load& load);

/// A second-order low-pass filter with a resonance. Its gain is 1 at 0 Hz, and 1 / (1 - r^2 + 2 i damping r)
/// at r times its resonance frequency. Integrated by the trapezoidal rule.
class Resonance {
 public:
  Resonance(double frequency_Hz, double damping, double rate_Hz);
  double step(double input);

 private:
  double g_, k_, a1_;
  double band_ = 0, low_ = 0;
};

/// Converts the forces on the cells to their readings (N), frame by frame: resonances, crosstalk, zero and
/// drift.
class CellReadings {
 public:
  CellReadings(const Cells& cells, double rate_Hz);
  /// Returns the readings of the next frame. `warmth_K` is the present temperature minus the temperature at
  /// which Cells::zero_N was measured.
  CellForces step(const CellForces& forces, double warmth_K);

 private:
  Cells cells_;
  std::array<Resonance, 3> resonances_;
};

}  // namespace turnpoint::simulation

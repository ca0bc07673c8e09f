#include "station/simulation/cells.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace turnpoint::simulation {

CellForces forces_on(const Cells& cells, const Load& load) {
  const double share = (load.x_m - cells.first_m) / cells.span_m;
  const double tilt = cells.height_m * load.lateral_N / cells.span_m;
  return {load.normal_N * (1 - share) - tilt, load.normal_N * share + tilt, load.lateral_N};
}

// The filter's two integrators are solved together, without a delay between them (Simper, "Linear trapezoidal
// integrated state variable filter", 2013). A direct-form filter would lose digits, because it has
// coefficients of order (f / rate)^2.
Resonance::Resonance(double frequency_Hz, double damping, double rate_Hz)
    : g_(std::tan(std::numbers::pi * frequency_Hz / rate_Hz)),
      k_(2 * damping),
      a1_(1 / (1 + g_ * (g_ + k_))) {}

double Resonance::step(double input) {
  const double v3 = input - low_;
  const double v1 = a1_ * (band_ + g_ * v3);
  const double v2 = low_ + g_ * v1;
  band_ = 2 * v1 - band_;
  low_ = 2 * v2 - low_;
  return v2;
}

CellReadings::CellReadings(const Cells& cells, double rate_Hz)
    : cells_(cells),
      resonances_{Resonance(cells.normal_Hz, cells.damping, rate_Hz),
                  Resonance(cells.normal_Hz, cells.damping, rate_Hz),
                  Resonance(cells.lateral_Hz, cells.damping, rate_Hz)} {}

CellForces CellReadings::step(const CellForces& forces, double warmth_K) {
  CellForces moved{}, reading{};
  for (std::size_t c = 0; c < 3; ++c) moved[c] = resonances_[c].step(forces[c]);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto& row = cells_.crosstalk[c];
    reading[c] = row[0] * moved[0] + row[1] * moved[1] + row[2] * moved[2] + cells_.zero_N[c] +
                 cells_.drift_N_per_K * warmth_K;
  }
  return reading;
}

}  // namespace turnpoint::simulation

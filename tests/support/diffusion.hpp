#pragma once
#include "station/analysis/diffusion.hpp"
#include "station/simulation/first_passage.hpp"

namespace turnpoint::tests {

struct Decision {
  bool correct = false;
  double time_s = 0;  ///< response time, including the non-decision time
};

/// Simulates one decision of a diffusion with these parameters and noise of s = 0.1 (SD after 1 s).
inline Decision sample_decision(const analysis::DiffusionParameters& parameters, core::Draws& draws) {
  const double s = analysis::kDiffusionScale;
  const auto passage =
      simulation::first_passage(parameters.drift / s, parameters.boundary / (2 * s), 0, draws);
  return {passage.upper, passage.time_s + parameters.nondecision_s};
}

}  // namespace turnpoint::tests

#pragma once
// A pure tone that drives the edge of the surface.
#include <memory>
#include <vector>

namespace turnpoint::physics {

// The displacement of the drive edge's centre is amplitude_m cos(2 pi frequency_Hz t + phase_rad), before any
// gain of the surface. amplitude_m is a peak value.
struct Tone {
  double frequency_Hz = 0;
  double amplitude_m = 1;
  double phase_rad = 0;
};

class CentreLine;
// The solutions of a model, one for each tone (see PlanChoice), or none.
using SolvedLines = std::vector<std::shared_ptr<const CentreLine>>;

}  // namespace turnpoint::physics

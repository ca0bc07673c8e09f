#pragma once
// A pure tone of the drive edge.

namespace turnpoint::physics {

// Displacement of the drive edge's centre, amplitude_m cos(2 pi frequency_Hz t + phase_rad), before any gain
// of the surface. amplitude_m is a peak value.
struct Tone {
  double frequency_Hz = 0;
  double amplitude_m = 1;
  double phase_rad = 0;
};

}  // namespace turnpoint::physics

#pragma once
#include <array>

#include "station/drive/prepared_burst.hpp"

namespace turnpoint::drive {

/// Per channel: the largest sum of amplitudes (of tones in any of the sets, marker, noise) that could ever
/// occur.
std::array<double, max_channels> peak_bound(const PreparedBurst& burst);

/// Per channel: the largest sample of the whole burst, by rendering it (about 1 ns per tone and frame).
std::array<double, max_channels> rendered_peak(const PreparedBurst& burst, const Format& format);

/// Root mean square of a noise's filters for the generator's uniform input at gain 1.
double noise_rms(const PreparedNoise& noise);

}  // namespace turnpoint::drive

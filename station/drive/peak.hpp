#pragma once
#include <array>

#include "station/drive/prepared_burst.hpp"

namespace turnpoint::drive {

/// Per channel: the largest sum of amplitudes that could ever occur, of the tones of any one set (a glide
/// between two sets stays below the larger), marker and noise.
std::array<double, max_channels> peak_bound(const PreparedBurst& burst);

/// The same while the burst plays the tones of this change.
std::array<double, max_channels> peak_bound(const PreparedBurst& burst, const PreparedChange& change);

/// Per channel: the largest sample of the whole burst, by rendering it (about 1 ns per tone and frame).
std::array<double, max_channels> rendered_peak(const PreparedBurst& burst, const Format& format);

/// Root mean square of a noise's filters for the generator's uniform input at gain 1.
double noise_rms(const PreparedNoise& noise);

}  // namespace turnpoint::drive

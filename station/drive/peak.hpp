#pragma once
#include <array>

#include "station/drive/prepared_burst.hpp"

namespace turnpoint::drive {

/// For each channel, the largest amplitude sum that could ever occur: the tones of any one set (a glide
/// between two sets stays below the larger one), the marker and the noise.
std::array<double, max_channels> peak_bound(const PreparedBurst& burst);

/// The same bound for the time in which the burst plays the tones of this change.
std::array<double, max_channels> peak_bound(const PreparedBurst& burst, const PreparedChange& change);

/// For each channel, the largest sample of the whole burst, found by rendering it (about 1 ns per tone and
/// frame).
std::array<double, max_channels> rendered_peak(const PreparedBurst& burst, const Format& format);

/// Root mean square of the filtered noise for uniform input at gain 1.
double noise_rms(const PreparedNoise& noise);

}  // namespace turnpoint::drive

#pragma once
#include <array>

#include "station/drive/prepared_burst.hpp"

namespace turnpoint::drive {

/// An upper limit of the samples of each channel: the largest sum of amplitudes of any one tone set, plus the
/// marker and the noise. During a glide between two sets, samples stay below the larger limit of the two.
std::array<double, max_channels> peak_bound(const PreparedBurst& burst);

/// Like the function above, but only for the time in which the burst plays the tones of `change`.
std::array<double, max_channels> peak_bound(const PreparedBurst& burst, const PreparedChange& change);

/// For each channel, the largest sample of the whole burst, found by rendering it (about 1 ns per tone and
/// frame).
std::array<double, max_channels> rendered_peak(const PreparedBurst& burst, const Format& format);

/// Root mean square of the filtered noise if its input is uniform in (-1, 1) and its gain is 1.
double noise_rms(const PreparedNoise& noise);

}  // namespace turnpoint::drive

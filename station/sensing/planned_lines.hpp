#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "station/sensing/pick_up.hpp"
#include "station/sensing/planned_stretches.hpp"

namespace turnpoint::sensing {

/// All tones with the same frequency in one steady part of a burst. Only their sum can be measured.
struct PlannedLine {
  std::uint64_t phase = 0, increment = 0;  ///< phase of the first of these tones, in 2^-64 cycles
  double frequency_Hz = 0;
  double gain = 1;  ///< gain of the high-pass filter at this frequency (high_pass_gain())
  std::vector<PlannedTone> tones;
  /// The complex amplitude that each pick-up should capture, relative to `phase` and before the high-pass
  /// filter.
  std::vector<std::complex<double>> expected;
  std::vector<double> seen;  ///< response of each pick-up relative to its best response; 0 if not calibrated
};

std::vector<PlannedLine> planned_lines(const Stretch& stretch, const std::vector<PickUp>& pick_ups,
                                       int rate_Hz);

/// The pick-up with the best response to these lines.
std::size_t main_pick_up(const std::vector<PlannedLine>& lines, std::size_t pick_ups);

/// Mean square that a pick-up should capture of the lines, after the high-pass filter.
double planned_power(const std::vector<PlannedLine>& lines, std::size_t pick_up);

/// A ratio of amplitudes in dB, at least -200.
inline double in_dB(double ratio) { return 20 * std::log10(std::max(ratio, 1e-10)); }

}  // namespace turnpoint::sensing

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
  /// each pick-up's response as a fraction of its largest response; 0 if not calibrated
  std::vector<double> seen;
};

std::vector<PlannedLine> planned_lines(const Stretch& stretch, const std::vector<PickUp>& pick_ups,
                                       int rate_Hz);

/// Returns the index of the pick-up that captures these lines (tones) most strongly. `pick_ups` is the number
/// of pick-ups.
std::size_t main_pick_up(const std::vector<PlannedLine>& lines, std::size_t pick_ups);

/// Returns the mean square of the samples that a pick-up should capture if all lines play as planned, after
/// the high-pass filter.
double planned_power(const std::vector<PlannedLine>& lines, std::size_t pick_up);

/// Converts a ratio of amplitudes to dB; the result is at least -200.
inline double in_dB(double ratio) { return 20 * std::log10(std::max(ratio, 1e-10)); }

}  // namespace turnpoint::sensing

#pragma once
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdint>
#include <vector>

#include "station/sensing/pick_up.hpp"
#include "station/sensing/planned_stretches.hpp"

namespace turnpoint::sensing {

/// The tones of a stretch that have the same frequency. Only their sum can be measured.
struct PlannedLine {
  std::uint64_t phase = 0, increment = 0;  ///< of the first of them, in 2^-64 cycles
  double frequency_Hz = 0;
  double gain = 1;  ///< of the filter against low frequencies (high_pass_gain())
  std::vector<PlannedTone> tones;
  /// Captured complex amplitude that the plan leads to, one for each pick-up; relative to `phase`, without
  /// the filter.
  std::vector<std::complex<double>> expected;
  std::vector<double> seen;  ///< response / best response of each pick-up; 0 if it is not calibrated
};

std::vector<PlannedLine> planned_lines(const Stretch& stretch, const std::vector<PickUp>& pick_ups,
                                       int rate_Hz);

/// The pick-up that sees most of these lines.
std::size_t main_pick_up(const std::vector<PlannedLine>& lines, std::size_t pick_ups);

/// Mean square that the lines lead to at a pick-up, behind the filter.
double planned_power(const std::vector<PlannedLine>& lines, std::size_t pick_up);

/// A ratio of amplitudes in dB, at least -200.
inline double in_dB(double ratio) { return 20 * std::log10(std::max(ratio, 1e-10)); }

}  // namespace turnpoint::sensing

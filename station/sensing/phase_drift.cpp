#include "station/sensing/phase_drift.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace turnpoint::sensing {

std::vector<PickUp> scaled(std::vector<PickUp> pick_ups, double share) {
  for (auto& pick_up : pick_ups)
    for (auto& transfer : pick_up.transfers)
      for (double& f : transfer.frequency_Hz) f *= 1 + share;
  return pick_ups;
}

double phase_slope_rad(const PickUp& pick_up, int drive_channel, double frequency_Hz) {
  return -2 * std::numbers::pi * frequency_Hz * group_delay_s(pick_up, drive_channel, frequency_Hz);
}

std::optional<PhaseDrift> DriftTracker::take(std::span<const ToneProof> tones, double applied) {
  // The phase is not exactly linear in the frequency, so the drift is computed in several steps, each of
  // which starts from the result of the previous step.
  constexpr int steps = 5;
  PhaseDrift drift;
  double more = 0;
  for (int step = 0; step < steps; ++step) {
    double slope_error = 0, slope_square = 0, error_square = 0;
    drift.tones = 0;
    for (const ToneProof& tone : tones) {
      if (!tone.seen || tone.pick_up < 0) continue;
      const auto& pick_up = pick_ups_.at(static_cast<std::size_t>(tone.pick_up));
      const double calibrated_Hz = tone.frequency_Hz / (1 + applied), moved_Hz = calibrated_Hz / (1 + more);
      const auto before = response(pick_up, tone.drive_channel, calibrated_Hz),
                 after = response(pick_up, tone.drive_channel, moved_Hz);
      if (!before || !after) continue;
      const double explained = std::arg(*after * std::conj(*before));
      const double error =
          std::remainder(tone.phase_error_deg * std::numbers::pi / 180 - explained, 2 * std::numbers::pi);
      const double slope = phase_slope_rad(pick_up, tone.drive_channel, moved_Hz);
      slope_error += slope * error;
      slope_square += slope * slope;
      error_square += error * error;
      ++drift.tones;
    }
    if (!(slope_square > 0)) return std::nullopt;
    const double change = -slope_error / slope_square;
    more += change;
    const double left = std::max(0.0, error_square - slope_error * slope_error / slope_square);
    drift.sd = drift.tones > 1 ? std::sqrt(left / (drift.tones - 1) / slope_square) : 0;
  }
  drift.share = (1 + applied) * (1 + more) - 1;
  return drift;
}

}  // namespace turnpoint::sensing

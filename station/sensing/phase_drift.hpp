#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "station/sensing/interval_result.hpp"
#include "station/sensing/pick_up.hpp"

namespace turnpoint::sensing {

/// The relative change of the surface's resonance frequencies since the calibration. A warmer plate is
/// softer: about -2.3e-4 per kelvin for aluminium.
struct PhaseDrift {
  double share = 0;
  double sd = 0;  ///< standard error of `share`; 0 if only one tone was measured
  int tones = 0;
};

/// Measures the drift of the resonances from the phases of the tones that a session plays anyway. If all
/// resonance frequencies rise by the fraction s, a response H(f) becomes H(f / (1 + s)), so the phase at a
/// frequency changes by -s d phase / d ln f. The slope d phase / d ln f comes from the calibration.
class DriftTracker {
 public:
  explicit DriftTracker(std::vector<PickUp> pick_ups) : pick_ups_(std::move(pick_ups)) {}

  /// Takes the tones of one interval. Their phase errors must be relative to the calibration scaled by
  /// `applied` (see scaled()). Returns the newest estimate, relative to the calibration itself; empty if no
  /// tone of this interval could be judged.
  std::optional<PhaseDrift> take(std::span<const ToneProof> tones, double applied);

 private:
  std::vector<PickUp> pick_ups_;
};

/// The responses of pick-ups after all resonance frequencies have risen by the fraction `share`.
std::vector<PickUp> scaled(std::vector<PickUp> pick_ups, double share);

/// d phase / d ln f (rad) of the response to an output channel at a frequency; 0 if the calibration does not
/// cover it.
double phase_slope_rad(const PickUp& pick_up, int drive_channel, double frequency_Hz);

}  // namespace turnpoint::sensing

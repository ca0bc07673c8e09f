#pragma once
#include <optional>

#include "station/sensing/friction_profile.hpp"

namespace turnpoint::sensing {

/// The place along the strip at which friction changes under the moving finger. It can be compared with a
/// planned edge that is defined by friction if both use the same level. (The turning point of a mode is a
/// different place.)
struct FeltStep {
  /// position of the boundary: mean of both directions, because the skin lags behind the finger
  double boundary_mm = 0;
  double se_mm = 0;             ///< standard error of boundary_mm
  double half_interval_mm = 0;  ///< half-width of the 95 % interval: se_mm times Student's t
  /// half the difference between the boundaries of the two directions; positive if the change comes late in
  /// each direction of movement
  double lag_mm = 0;
  double friction_below = 0, friction_above = 0;  ///< friction at smaller and at larger positions
};

/// Fits a step with the shape of a normal distribution function to the mean friction of each direction, with
/// the soft-L1 loss so that single bins with a large error have little influence. The final fit leaves out
/// bins far from the step, where nodes of the vibration change friction again. The boundary is where the
/// fitted friction is `level` times the friction at larger positions, which is the definition of a planned
/// edge { friction = level }; without a level it is half-way up the step. For steps such as those of real
/// plates, a boundary at a level from 0.3 to 0.65 is within 0.15 mm of the place where the true mean friction
/// crosses that level, and at 0.8 within 0.3 mm.
///
/// The standard error has two parts. What differs between strokes comes from leaving out one stroke at a time
/// (jackknife), and assumes the same variance in both directions. What all strokes share is the shape of the
/// step, which is not quite that of the fit: what the fit misses in the bins, as far as the strokes do not
/// explain it by their scatter, counts as an error of each bin. Errors of the calibration of the force cells
/// are in neither part. deploy/rigs/README.md says how often the interval holds.
///
/// The result is empty with fewer than three strokes, without strokes in both directions, if a boundary is
/// not inside the bins, if friction does not rise through the level, or if the height of the step is not
/// clearly larger than its uncertainty.
std::optional<FeltStep> felt_step(const FrictionProfile& profile, std::optional<double> level = {});

}  // namespace turnpoint::sensing

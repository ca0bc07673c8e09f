#pragma once
#include <optional>

#include "station/sensing/friction_profile.hpp"

namespace turnpoint::sensing {

/// Where friction changes along the strip, as measured by the finger. Compare it with the planned edge of
/// friction, not with the turning point of a mode.
struct FeltStep {
  double boundary_mm = 0;       ///< mean of both directions, because the skin lags behind the finger
  double se_mm = 0;             ///< standard error of boundary_mm
  double half_interval_mm = 0;  ///< half-width of the 95 % interval: se_mm times Student's t
  double lag_mm = 0;            ///< half the difference of the directions; positive if the change comes late
  double friction_below = 0, friction_above = 0;  ///< at smaller and at larger positions than the boundary
};

/// Fits a logistic step to the mean friction of each direction, with the soft-L1 loss so that single bins
/// cannot pull it away. The standard error comes from leaving out one stroke at a time (jackknife), and
/// assumes the same variance in both directions. The result is empty with fewer than three strokes, without
/// strokes in both directions, if a step is not inside the bins, or if its height is not clearly larger than
/// its uncertainty.
std::optional<FeltStep> felt_step(const FrictionProfile& profile);

}  // namespace turnpoint::sensing

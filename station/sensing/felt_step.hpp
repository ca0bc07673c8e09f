#pragma once
#include <optional>

#include "station/sensing/friction_profile.hpp"

namespace turnpoint::sensing {

/// Where friction changes along the strip, as the finger met it. Compare it with the edge of friction that
/// the plan intends, not with the turning point of a mode.
struct FeltStep {
  double boundary_mm = 0;       ///< mean of the two directions, because the skin lags behind the finger
  double se_mm = 0;             ///< standard error
  double half_interval_mm = 0;  ///< the 95 % interval is boundary_mm -+ this: se_mm times Student's t
  double lag_mm = 0;  ///< half the difference: how far the change lies ahead in the direction of movement
  double friction_below = 0, friction_above = 0;  ///< at smaller and at larger positions
};

/// Fits a logistic step to the mean friction of each direction, with the soft-L1 loss so that single bins
/// cannot pull it away. The standard error comes from leaving out one stroke at a time (jackknife), with a
/// variance common to both directions. Empty with fewer than three strokes, without both directions, if a
/// step is not inside the bins, or if its height is not clearly larger than its own standard error.
std::optional<FeltStep> felt_step(const FrictionProfile& profile);

}  // namespace turnpoint::sensing

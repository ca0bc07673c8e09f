#pragma once
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// A part of the surface, in m from the wide end.
struct Stretch {
  double from_m = 0, to_m = 0;
};

/// Returns the displacement that a plan predicts for this part of the surface (rms over the part, without a
/// finger). Throws core::UsageError if the part is not on the surface.
double mean_displacement_m(Planner& planner, const DrivePlan& plan, const Stretch& stretch);

/// Returns the plan with all amplitudes multiplied by `factor`; a factor of 0 removes the tones. Of the
/// predicted frictions, only the lowest on the whole surface (`lowest_friction`) is computed again.
/// `zone_friction`, `residual` and `audible_products` are cleared, because they would no longer be right.
DrivePlan scaled(Planner& planner, DrivePlan plan, double factor);

}  // namespace turnpoint::scene

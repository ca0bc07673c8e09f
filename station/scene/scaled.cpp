#include "station/scene/scaled.hpp"

#include <algorithm>
#include <cmath>

#include "station/core/number.hpp"
#include "station/scene/measures.hpp"

namespace turnpoint::scene {

using core::phrase, core::plain;

double mean_displacement_m(Planner& planner, const DrivePlan& plan, const Stretch& stretch) {
  const auto profile = planner.profile(plan, profile_points);
  double sum = 0;
  int points = 0;
  for (std::size_t i = 0; i < profile.x_m.size(); ++i)
    if (profile.x_m[i] >= stretch.from_m && profile.x_m[i] <= stretch.to_m)
      sum += std::pow(profile.displacement_m[i], 2), ++points;
  if (points == 0 || stretch.to_m > planner.surface().length_m)
    throw Unreachable(
        phrase("problem.not_on_surface",
               {plain(core::number(1e3 * stretch.from_m)), plain(core::number(1e3 * stretch.to_m)),
                plain(core::number(1e3 * planner.surface().length_m))}));
  return std::sqrt(sum / points);
}

DrivePlan scaled(Planner& planner, DrivePlan plan, double factor) {
  if (factor == 0) plan.tones.clear();
  for (auto& tone : plan.tones) {
    tone.amplitude_m *= factor;
    tone.full_scale *= factor;
    tone.displacement_m *= factor;
  }
  plan.peak_displacement_m *= factor;
  plan.peak_full_scale *= factor;
  plan.zone_friction.reset();
  plan.residual.reset();
  plan.audible_products.clear();
  plan.lowest_friction = 1;
  if (plan.tones.empty()) return plan;
  for (const double friction : planner.profile(plan, profile_points).friction)
    plan.lowest_friction = std::min(plan.lowest_friction, friction);
  return plan;
}

}  // namespace turnpoint::scene

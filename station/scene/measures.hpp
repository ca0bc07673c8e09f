#pragma once
#include <vector>

#include "physics/field.hpp"
#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Number of evenly spaced points along the surface, ends included, at which a plan is evaluated.
inline constexpr int profile_points = 601;

/// Fills in the predicted behaviour of the surface: peak displacement, lowest friction, mean and residual of
/// the zone's friction, cues. `fields` holds each tone's displacement (m) at `profile_points` points.
void measure(const physics::Surface& surface, const physics::FrictionMap& friction, const rig::Rig& rig,
             const std::vector<physics::Tone>& tones, const std::vector<physics::ToneField>& fields,
             DrivePlan& plan);

/// Returns the factor by which the amplitudes at the points `x_m` must be multiplied to give the zone the
/// mean friction that the scene specifies. Throws Unreachable if no factor does.
double scale_to_friction(const std::vector<double>& x_m, const std::vector<double>& amplitude_m,
                         const physics::FrictionMap& friction, const rig::Rig& rig, const Scene& scene);

/// Throws Unreachable if the plan exceeds the rig's largest displacement or full scale.
void refuse_beyond_limits(const rig::Rig& rig, const DrivePlan& plan);

/// Returns the relative change of amplitude that changes friction by `tolerance`, at the amplitude where
/// friction changes most steeply.
double amplitude_tolerance(const physics::FrictionMap& friction, double tolerance);

}  // namespace turnpoint::scene

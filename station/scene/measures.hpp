#pragma once
#include <vector>

#include "physics/field.hpp"
#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Number of evenly spaced profile points on which a plan is measured, from 0 to the length, ends included.
inline constexpr int profile_points = 601;

/// Fills in the predicted behaviour of the surface: peak displacement, lowest friction, zone friction and
/// residual, cues. `fields` are the tones' displacements (m) at `profile_points` points.
void measure(const physics::Surface& surface, const physics::FrictionMap& friction, const rig::Rig& rig,
             const std::vector<physics::Tone>& tones, const std::vector<physics::ToneField>& fields,
             DrivePlan& plan);

/// The factor for all amplitudes that makes the zone's mean friction equal to the scene's. Throws Unreachable
/// if there is none.
double scale_to_friction(const physics::Surface& surface, const physics::FrictionMap& friction,
                         const rig::Rig& rig, const std::vector<physics::Tone>& tones, const Scene& scene);

/// The relative amplitude error that changes friction by `tolerance` where the map is steepest.
double amplitude_tolerance(const physics::FrictionMap& friction, double tolerance);

}  // namespace turnpoint::scene

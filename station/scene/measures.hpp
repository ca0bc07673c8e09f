#pragma once
#include <vector>

#include "physics/field.hpp"
#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Points of the profile that a plan is measured on, from 0 to length inclusive.
inline constexpr int profile_points = 601;

/// Fills in what the surface will do: peak displacement, lowest friction, zone friction and residual, cues.
/// `fields` are the tones' displacements (m) at `profile_points` points.
void measure(const physics::Surface& surface, const physics::FrictionMap& friction, const rig::Rig& rig,
             const std::vector<physics::Tone>& tones, const std::vector<physics::ToneField>& fields,
             DrivePlan& plan);

/// By how much all amplitudes must be multiplied so that the zone's mean friction is the scene's. Throws
/// Unreachable where no scale does it.
double scale_to_friction(const physics::Surface& surface, const physics::FrictionMap& friction,
                         const rig::Rig& rig, const std::vector<physics::Tone>& tones, const Scene& scene);

/// The relative error of an amplitude that changes friction by `tolerance` where the map is steepest.
double amplitude_tolerance(const physics::FrictionMap& friction, double tolerance);

}  // namespace turnpoint::scene

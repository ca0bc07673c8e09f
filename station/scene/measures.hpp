#pragma once
#include <vector>

#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Fills in what the surface will do: peak displacement, lowest friction, zone friction and residual, cues,
/// each tone's boundary. Amplitudes by `mode`: a limit must not rest on a coarse model.
void measure(const physics::Surface& surface, const physics::FrictionMap& friction, const rig::Rig& rig,
             const std::vector<physics::Tone>& tones, DrivePlan& plan);

/// By how much all amplitudes must be multiplied so that the zone's mean friction is the scene's. Throws
/// Unreachable where no scale does it.
double scale_to_friction(const physics::Surface& surface, const physics::FrictionMap& friction,
                         const rig::Rig& rig, const std::vector<physics::Tone>& tones, const Scene& scene);

/// The relative error of an amplitude that changes friction by `tolerance` where the map is steepest.
double amplitude_tolerance(const physics::FrictionMap& friction, double tolerance);

}  // namespace turnpoint::scene

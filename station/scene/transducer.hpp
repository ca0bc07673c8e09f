#pragma once
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Assigns a tone to the first transducer whose band contains its frequency: returns it with transducer,
/// channel, full_scale and output phase. If no band contains it, throws Unreachable with a list of the bands.
PlannedTone on_transducer(const rig::Rig& rig, const physics::Tone& tone);

/// Return the lowest and the highest frequency that the transducers can play. The lowest is at least
/// `preferred_Hz`, unless all bands lie below it. The highest is at most `limit_Hz`.
double lowest_frequency(const rig::Rig& rig, double preferred_Hz);
double highest_frequency(const rig::Rig& rig, double limit_Hz);

}  // namespace turnpoint::scene

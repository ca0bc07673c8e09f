#pragma once
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Gives the tone to the first transducer whose band holds its frequency and fills in transducer, channel,
/// full_scale and output phase. Throws Unreachable naming the bands where none does.
void assign_transducer(const rig::Rig& rig, DrivenTone& tone);

/// The lowest and highest frequency that the transducers reach; the lowest not below `preferred_Hz` where the
/// bands reach above it, the highest below `limit_Hz`.
double lowest_frequency(const rig::Rig& rig, double preferred_Hz);
double highest_frequency(const rig::Rig& rig, double limit_Hz);

}  // namespace turnpoint::scene

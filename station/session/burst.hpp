#pragma once
#include <cstdint>
#include <vector>

#include "station/drive/burst.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::session {

/// Converts the tones of a plan for the drive. Throws std::length_error if there are too many.
drive::ToneSet tones_of(const scene::DrivePlan& plan);

/// Converts one interval to a burst of the drive. The burst plays the plans of the interval's scenes in turn;
/// the second and later ones begin at `starts_s` from the onset, with a transition of `transition_s`. The
/// total length is `length_s`, including both ramps. Tone i of a scene glides to tone i of the next. Throws
/// std::length_error if the drive has no room.
drive::Burst burst_of(const std::vector<scene::DrivePlan>& scenes, const std::vector<double>& starts_s,
                      double transition_s, double length_s, int rate_Hz);

/// Adds the rig's marker at the onset and at each change, never longer than the burst.
void mark(drive::Burst& burst, const rig::Marker& marker, int rate_Hz);

/// Adds the rig's masking noise. `seed` gives each interval a different noise.
void mask(drive::Burst& burst, const rig::MaskingNoise& noise, std::uint64_t seed);

}  // namespace turnpoint::session

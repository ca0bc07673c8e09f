#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "station/audio/burst.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::session {

/// Converts a planned tone, or all tones of a plan, to the drive's form. Throws std::length_error if there
/// are too many tones.
audio::Tone driven(const scene::PlannedTone& tone);
audio::ToneSet tones_of(const scene::DrivePlan& plan);

/// Converts one interval to a burst of the drive. The burst plays the plans of the interval's scenes one
/// after the other. The second and later plans begin at `starts_s` from the onset, each with a transition
/// of one of `transitions_s`, in which tone i of one scene glides to tone i of the next. The burst lasts
/// `length_s`, including both ramps. A scene that follows the finger must be the only one of its burst.
/// Throws std::length_error if a burst cannot hold that many tones or scenes.
audio::Burst burst_of(const std::vector<scene::DrivePlan>& scenes, const std::vector<double>& starts_s,
                      const std::vector<double>& transitions_s, double length_s, int rate_Hz);

/// Adds the rig's marker at the onset and at each change of scene. A pulse or tone never lasts longer than
/// the burst. If the marker carries trigger codes, `MarkerCodes` holds the codes of the onset and of each of
/// the first `changes` changes; 0 stands for no code. Later changes (to a buzz and back) have no code.
struct MarkerCodes {
  int onset = 0, change = 0;
  std::size_t changes = audio::max_changes;
};
void mark(audio::Burst& burst, const rig::Marker& marker, int rate_Hz, const MarkerCodes& codes = {});

/// Adds the tone on the rig's headphones that asks for an answer, `at_s` after the burst's onset. It lasts
/// 50 ms (core::kSignal_s), with ramps of 5 ms.
void signal(audio::Burst& burst, const rig::MaskingNoise& headphones, double at_s, int rate_Hz);

/// Adds the rig's masking noise. A different `seed` for each interval gives each interval different noise.
void mask(audio::Burst& burst, const rig::MaskingNoise& noise, std::uint64_t seed);

/// Plans one scene on its own, without a trial, a marker or a masking sound. Throws scene::Unreachable.
audio::Burst scene_burst(const rig::Rig& rig, const protocol::Protocol& protocol, const std::string& scene,
                         const protocol::Factors& factors, double length_s);

}  // namespace turnpoint::session

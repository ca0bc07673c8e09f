#pragma once
#include <string_view>
#include <vector>

#include "station/rehearsal/cue_table.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::rehearsal {

/// What the cue is a property of.
enum class Source { surface, duration, nothing };

/// One of the cues that an observer may use.
struct CueKind {
  const char* name;
  const char* unit;
  double scale;  ///< from the unit of the member `cue` to `unit`
  Source source;
  double scene::Cues::*cue;  ///< null unless the source is the surface
  bool follows_strength;     ///< true if roving the strength always changes this cue

  bool in_dB() const { return std::string_view(unit) == "dB"; }
};

/// All cues. The last one stands for an observer without a cue.
inline constexpr CueKind cue_kinds[] = {
    {"pitch", "Hz", 1, Source::surface, &scene::Cues::pitch_Hz, false},
    {"loudness", "dB", 1, Source::surface, &scene::Cues::loudness_dB, true},
    {"amplitude at the wide end", "um", 1e6, Source::surface, &scene::Cues::wide_end_amplitude_m, true},
    {"stripe pitch at the wide end", "mm", 1e3, Source::surface, &scene::Cues::stripe_pitch_m, false},
    {"edge sharpness", "mm", 1e3, Source::surface, &scene::Cues::edge_width_m, false},
    {"strip width", "mm", 1e3, Source::surface, &scene::Cues::strip_width_m, false},
    {"duration", "s", 1, Source::duration, nullptr, false},
    {"always the same key", "", 1, Source::nothing, nullptr, false},
};

/// Which value of a cue (pitch, loudness, ...) the observer uses in an interval of several scenes: that of
/// the last scene, its difference from the first, or that of the first. Features from `one` on are one scene
/// each, counted from 0. Of durations, `last` is that of the whole interval, and from `one` on come those of
/// its scenes and of the silences between them, in order.
enum class Feature { last, change, first, one };

inline Feature feature_of_one(std::size_t number) {
  return static_cast<Feature>(static_cast<int>(Feature::one) + static_cast<int>(number));
}

/// The cues of the scenes of an interval, for any strength that roving may draw.
struct Interval {
  std::vector<RovedCues> scenes;
  std::vector<double> rove_dB;  ///< for each scene: by how much its strength may be roved
  double duration_s = 0;
  std::vector<double> lengths_s;  ///< of scenes and silences; empty if the interval has only one part
};

/// Returns the value of a cue in an interval whose scenes were roved by `share` of what they allow, from -1
/// to 1, in SI units. Returns 0 if there is no cue.
double value_of(const CueKind& kind, const Interval& interval, Feature feature, double share);

/// True if roving can change the value of this cue in this interval.
bool roves(const CueKind& kind, const Interval& interval);

}  // namespace turnpoint::rehearsal

#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/audio/prepared_burst.hpp"
#include "station/core/records.hpp"
#include "station/protocol/protocol.hpp"
#include "station/scene/planner.hpp"
#include "station/session/follow_loop.hpp"
#include "station/session/inputs.hpp"
#include "station/simulation/observer.hpp"
#include "station/trial/director.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::session {

/// Appends the tones of a part to a trial's row: its number in the trial, and that of the interval to which
/// it belongs. The trial's boundary, frequency and amplitude become those of the part's last scene.
void add_tones(core::TrialRow& row, const std::vector<scene::DrivePlan>& scenes, int part, int interval,
               std::int64_t onset_frame, const audio::PreparedBurst& burst);

/// Records that the surface begins to follow the slider of an adjustment at `frame`, in this interval. In the
/// row, scene 0 remains the scene at the start of the interval, and `scene` becomes scene 1. The boundary,
/// frequency and amplitude of the trial become those of scene 1.
void set_scene(core::TrialRow& row, const scene::DrivePlan& scene, int interval, std::int64_t frame);

/// Adds the measurements of an interval to the row: to the tones of the interval, and to the verdict on the
/// trial, which is that of the worst interval. `first` means that no interval of this trial has been added
/// yet.
void add_measured(core::TrialRow& row, const sensing::IntervalResult& measured, int interval, bool first);

/// A playback frame, and its time since the start of the segment (the run of the program).
struct FrameTime {
  std::int64_t frame = 0;
  double time_s = 0;
};
/// Returns the ranges of force and speed that the protocol asks for.
sensing::MovementWindow window_of(const protocol::Sensing& sensing);
/// The friction, relative to the surface at rest, at which the scene's boundary is planned; empty if the
/// boundary is not defined by friction.
std::optional<double> friction_level(const scene::Scene& scene);
/// What to compute from a trial's force signals: `friction_level` defines the boundary to look for, and
/// `part` is the part of the surface over which friction is averaged.
struct Asked {
  /// friction at which the boundary is planned, see friction_level(); if empty, the measured boundary lies
  /// where friction is half-way up its step
  std::optional<double> friction_level;
  sensing::StripPart part;  ///< the part of the surface in which friction is averaged
};
/// The stream of a trial's signal that add_forces() adds.
inline constexpr const char* kFingerStream = "finger";
/// Returns the part of the surface in which the trial's friction is averaged: in a trial for a friction
/// table, the part that the table describes; otherwise the whole surface.
sensing::StripPart part_of(const trial::TrialSpec& spec);
/// Adds what the force cells measured in a trial: the summary, the felt boundary, friction, and the signal of
/// the finger.
void add_forces(core::TrialRow& row, const sensing::TrialForces& forces, const Asked& asked, int rate_Hz,
                const FrameTime& at);

/// Adds what the intervals of a trial did that follow the finger: the summary of the interval presented last,
/// the faults of all, and the signals of updates and gains. `plans` are those of the intervals, null for
/// those that follow nothing; `ranges` are the frames in which they were presented. If the row has an earlier
/// presentation of the trial already, only the names of its faults remain, before the new ones.
struct FollowedRange {
  std::int64_t first_frame = 0, end_frame = 0;
};
void add_followed(core::TrialRow& row, const Followed& followed, const FollowPlans& plans,
                  const std::vector<FollowedRange>& ranges, int rate_Hz, const FrameTime& at);

/// Says what a pick-up found wrong with a trial, with figures: "the surface does not move (-62.1 dB)".
std::string describe_proof(const core::SurfaceRow& surface);

core::EventRow event_row(const Input& input, int trial_index);

}  // namespace turnpoint::session

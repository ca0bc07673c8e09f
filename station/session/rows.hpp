#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/drive/prepared_burst.hpp"
#include "station/observer/observer.hpp"
#include "station/protocol/protocol.hpp"
#include "station/records/records.hpp"
#include "station/scene/planner.hpp"
#include "station/session/inputs.hpp"
#include "station/trial/director.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::session {

/// Appends an interval's tones, and takes boundary, frequency and amplitude of the trial from its last scene.
void add_tones(records::TrialRow& row, const std::vector<scene::DrivePlan>& scenes, int interval,
               std::int64_t onset_frame, const drive::PreparedBurst& burst);

/// An adjustment's surface has begun to follow the slider at this frame: scene 0 stays what the trial began
/// with, scene 1 becomes this one; boundary, frequency and amplitude of the trial are its.
void set_scene(records::TrialRow& row, const scene::DrivePlan& scene, std::int64_t frame);

records::EventRow event_row(const Input& input, int trial_index);

}  // namespace turnpoint::session

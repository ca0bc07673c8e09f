#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/drive/prepared_burst.hpp"
#include "station/observer/observer.hpp"
#include "station/protocol/protocol.hpp"
#include "station/scene/planner.hpp"
#include "station/session/director.hpp"
#include "station/session/inputs.hpp"
#include "station/store/records.hpp"
#include "station/trial/trial.hpp"

namespace turnpoint::session {

// What happens in a sitting, as rows of the store.

store::BlockStart block_start(const protocol::Block& block, int block_index, int attempt);

/// A trial's row with all that is known before it runs.
store::TrialRow row_of(const TrialSpec& spec, const protocol::Protocol& protocol, int trial_index);

/// Appends an interval's tones, and takes boundary, frequency and amplitude of the trial from its last scene.
void add_tones(store::TrialRow& row, const std::vector<scene::DrivePlan>& scenes, int interval,
               std::int64_t onset_frame, const drive::PreparedBurst& burst);

/// An adjustment's surface has begun to follow the slider at this frame: scene 0 stays what the trial began
/// with, scene 1 becomes this one; boundary, frequency and amplitude of the trial are its.
void set_scene(store::TrialRow& row, const scene::DrivePlan& scene, std::int64_t frame);

/// Outcome, response and times; `origin_ns` is the start of the segment.
void fill_result(store::TrialRow& row, const trial::Result& result, const TrialSpec& spec,
                 const protocol::Protocol& protocol, std::int64_t origin_ns);

store::EventRow event_row(const Input& input, int trial_index);
const char* name(TimeQuality quality);

/// The input as an event of the trial machine; none where the machine is not concerned.
std::optional<trial::Event> event_of(const Input& input);

/// The question to a simulated observer that the trial's last interval asks.
observer::Question question_of(const TrialSpec& spec, const protocol::Protocol& protocol, std::uint64_t seed);

/// The slider that a simulated observer is to set.
observer::Adjustment adjustment_of(const TrialSpec& spec, std::uint64_t seed);

/// Runs a stored trial through the director again. Throws std::runtime_error where the director would have
/// presented another level, or its state differs afterwards: the log and the program do not belong together.
void replay(Director& director, const store::TrialRow& trial, const protocol::Protocol& protocol);

}  // namespace turnpoint::session

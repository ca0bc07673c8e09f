#pragma once
#include <cstdint>

#include "station/core/records.hpp"
#include "station/protocol/protocol.hpp"
#include "station/trial/director.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::trial {

core::BlockStart block_start(const protocol::Block& block, int block_index, int attempt);

/// Returns a trial's row with everything that is known before the trial runs.
core::TrialRow row_of(const TrialSpec& spec, const protocol::Protocol& protocol, int trial_index);

/// Fills in outcome, response and times. `origin_ns` is the start of the running segment of the session, from
/// which stored times are counted. If the answer is a number (the setting of a slider, a rating on a line, or
/// a typed number), it is passed as `value`.
void fill_result(core::TrialRow& row, const Result& result, const TrialSpec& spec,
                 const protocol::Protocol& protocol, std::int64_t origin_ns,
                 const std::optional<double>& value);

/// Returns what the result of a trial is worth to the participant. Empty if the protocol gives no points, for
/// void and warm-up trials, and for answers to questions without a right answer.
std::optional<double> points_of(const Result& result, const TrialSpec& spec,
                                const protocol::Protocol& protocol);

}  // namespace turnpoint::trial

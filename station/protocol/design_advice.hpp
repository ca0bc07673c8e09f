#pragma once
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::protocol {

/// What runs but makes no sense, each at the line of its key: a level that no scene depends on, answers that
/// are never right, labels that nobody can tell apart, instructions that nothing shows, levels that are never
/// presented, tones that are all ramp, rates and steps that do not fit the task.
std::vector<text::Problem> design_advice(const Protocol& protocol);

/// Matters of taste that a researcher should know of, each at the line of its key: levels of a factor that
/// `balance` cannot spread evenly, with the counts that result.
std::vector<text::Problem> notes(const Protocol& protocol);

}  // namespace turnpoint::protocol

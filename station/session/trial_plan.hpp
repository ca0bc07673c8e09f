#pragma once
#include "station/protocol/protocol.hpp"
#include "station/session/director.hpp"
#include "station/trial/trial.hpp"

namespace turnpoint::session {

/// How long the get-ready cue, the feedback and the message of a late answer stand.
inline constexpr double kCue_s = 0.8, kFeedback_s = 0.8, kLate_s = 1.0;

/// The trial machine's plan for a trial of this protocol in this block.
trial::Plan trial_plan(const protocol::Protocol& protocol, const protocol::Block& block,
                       const TrialSpec& spec);

/// Lengths of the intervals (s) and, in each, when its second and later scenes begin.
struct IntervalTimes {
  double length_s = 0;
  std::vector<double> starts_s;
};
std::vector<IntervalTimes> interval_times(const protocol::Protocol& protocol, const TrialSpec& spec);

}  // namespace turnpoint::session

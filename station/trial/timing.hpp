#pragma once
#include "station/protocol/protocol.hpp"
#include "station/trial/director.hpp"
#include "station/trial/machine.hpp"

namespace turnpoint::trial {

/// How long the get-ready cue, the feedback and the message after a late answer are shown.
inline constexpr double kCue_s = 0.8, kFeedback_s = 0.8, kLate_s = 1.0;

/// The timing of a trial of this protocol in this block.
Timing timing_of(const protocol::Protocol& protocol, const protocol::Block& block, const TrialSpec& spec);

/// Lengths of the intervals (s), and the times at which the second and later scenes begin in each.
struct IntervalTimes {
  double length_s = 0;
  std::vector<double> starts_s;
};
std::vector<IntervalTimes> interval_times(const protocol::Protocol& protocol, const TrialSpec& spec);

}  // namespace turnpoint::trial

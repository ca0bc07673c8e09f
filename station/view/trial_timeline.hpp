#pragma once
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::view {

/// One part of a trial, with its begin and end in seconds from the start of the trial.
struct TrialPart {
  enum class Kind { pause, interval, gap, answer } kind = Kind::pause;
  double from_s = 0, to_s = 0;
};

/// The parts of a typical trial in the order in which they begin: the pause before it, its intervals with the
/// gaps between them, and the time in which an answer counts. There is no answer part if the deadline depends
/// on factors, or on the movement of the finger.
std::vector<TrialPart> trial_timeline(const protocol::Protocol& protocol);

}  // namespace turnpoint::view

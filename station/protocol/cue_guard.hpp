#pragma once
#include <string>
#include <vector>

#include "station/protocol/survey.hpp"

namespace turnpoint::protocol {

/// What an observer could reach who attends to one cue only and sets the best criterion for it, the same for
/// all trials. A cue far above chance is either what the task asks for or a leak.
struct CueReport {
  std::string cue;           ///< "pitch", "loudness", "amplitude at the wide end", ...
  double low = 0, high = 0;  ///< over everything that the task presents, in `unit`
  std::string unit;
  double accuracy = 0;  ///< proportion right with the best criterion
  double chance = 0.5;
};

/// One report a cue, from the plans of a survey: single-interval tasks by the cue's value (of the change,
/// where an interval has two scenes), the others by whether the target's cue differs from the standard's in
/// one direction. Roving blurs what depends on the drive's strength. `always one key` is a cue too. Empty for
/// adjustment.
std::vector<CueReport> cue_guard(const Protocol& protocol, const Survey& survey);

}  // namespace turnpoint::protocol

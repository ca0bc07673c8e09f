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

/// A trial as one cue shows it: its value, and which of two answers (0 or 1) is right.
struct CueLook {
  double value = 0;
  int answer = 0;
};

/// Values below `cut` get the answer `below`, all others the other one.
struct CueCriterion {
  double cut = 0;
  int below = 0;
  double accuracy = 0.5;  ///< over the looks that it was chosen for
  int answer(double value) const { return value < cut ? below : 1 - below; }
};

/// The criterion that is right most often. Values closer than a thousandth of the largest are equal to
/// anybody and get one answer. Without looks: accuracy 1/2.
CueCriterion best_criterion(std::vector<CueLook> looks);

/// One report a cue, from the plans of a survey: single-interval tasks by the cue's value (of the change,
/// where an interval has two scenes), the others by whether the target's cue differs from the standard's in
/// one direction. Duration is that at half the amplitude: of two scenes equally long, the one with the longer
/// ramps is shorter. Roving blurs what depends on the drive's strength. `always one key` is a cue too. Empty
/// for adjustment.
std::vector<CueReport> cue_guard(const Protocol& protocol, const Survey& survey);

}  // namespace turnpoint::protocol

#pragma once
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "station/protocol/survey.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::simulation {

struct Reached {
  double accuracy = 0;  ///< proportion right
  double chance = 0;    ///< of the same trials without the cue: by guessing, or always with the same key
  double error = 0;     ///< three standard errors of either, or half the spread between levels; 0: exact
};

/// What an observer reaches who attends to one cue only. A cue far above chance is either what the task asks
/// for or a leak.
struct CueReport {
  std::string cue;           ///< "pitch", "loudness", "amplitude at the wide end", ...
  double low = 0, high = 0;  ///< over everything that the main trials present, in `unit`
  std::string unit;
  double accuracy = 0, chance = 0.5, error = 0;  ///< as in Reached
  /// Only where levels follow right answers. Then `accuracy`, `chance` and `error` are these or those with
  /// every level equally often, wherever accuracy and chance lie further apart.
  std::optional<Reached> whole_sessions = {};
};

struct CueGuard {
  std::vector<CueReport> reports;  ///< one a cue; empty where one of the following says why
  std::string nothing_to_tell;     ///< the task has no right answers that a cue could betray
  std::string not_compared;        ///< trials that could not be compared: nothing is known of any cue
};

/// Compares all that the main trials present: standard and target as they stand together in a trial, each
/// kind of trial weighted by how often it occurs (trial_census.hpp), catch trials included and practice left
/// out. Order of intervals and drawn factors are taken with their exact probabilities; of roving there are
/// two sets of at most 256 draws a trial, one that chooses the rule and one that says what it reaches.
///
/// The observer knows the task and the best rule for these trials: of one interval, a criterion or a band of
/// the cue (of what the interval ends with, begins with, or of its change where it has two scenes); of two
/// intervals the larger, the smaller, the one that differs more from the usual, or less; of three, the odd
/// one; same or different by a criterion or a band on the difference. Cues that differ by less than a
/// thousandth (0.01 dB of loudness) are equal. Who has no cue presses the one key that is
/// right most often: that is the last report.
///
/// A procedure that chooses levels by the answers counts with each level that it can present equally often.
/// Where it follows right answers, the observer also goes through simulated sessions by itself with the same
/// rule, so that its own answers set the levels: as many sessions as it takes that three standard errors are
/// 1 %, at most 1000. A rule that does equally well at each level, within 2 %, needs no sessions: it reaches
/// the same in any. The larger gain over chance is reported. Where it follows one of two answers (`tracks`)
/// such sessions say nothing: the share of that answer settles at the target whatever it depends on.
///
/// Duration is that at half the amplitude: of two equally long intervals, the one with the longer ramps is
/// shorter.
CueGuard cue_guard(const protocol::Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey,
                   const std::stop_token& stop = {});

}  // namespace turnpoint::simulation

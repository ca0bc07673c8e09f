#pragma once
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "station/protocol/survey.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::simulation {

struct Reached {
  double accuracy = 0;  ///< proportion correct
  /// proportion correct in the same trials without the cue: by guessing, or always with the same key
  double chance = 0;
  double error = 0;  ///< three standard errors of either, or half the spread between levels; 0: exact
};

/// The accuracy of an observer who uses only one cue. A cue far above chance is either what the task asks
/// about, or a leak.
struct CueReport {
  std::string cue;           ///< "pitch", "loudness", "amplitude at the wide end", ...
  double low = 0, high = 0;  ///< range over everything that the main trials present, in `unit`
  std::string unit;
  double accuracy = 0, chance = 0.5, error = 0;  ///< see Reached
  /// Set only if levels depend on right answers. Then `accuracy`, `chance` and `error` are either these or
  /// those with every level equally often, whichever has the larger gain over chance.
  std::optional<Reached> whole_sessions = {};

  /// The cue helps: its accuracy exceeds chance by more than about 20 trials can detect.
  bool above_chance() const { return accuracy > chance + 0.1; }
};

struct CueGuard {
  std::vector<CueReport> reports;  ///< one report per cue; if empty, one of the following says why
  std::string nothing_to_tell;     ///< the task has no right answers that a cue could reveal
  /// trials that could not be compared, so that nothing is known about any cue
  std::string not_compared;
};

/// Compares everything that the main trials present, standard and target as they occur together in a trial.
/// Each kind of trial is weighted by its frequency (trial_census.hpp). Catch trials are included, practice is
/// left out. Orders of intervals and drawn factors have their exact probabilities. Roving is sampled by two
/// sets of at most 256 draws per trial: one to choose the rule, one to measure its accuracy.
/// The observer knows the task and the best rule for these trials. With one interval, the rule is a criterion
/// or a band of the cue (at the end of the interval, at its start, or of the change if it has two scenes).
/// With two intervals, it chooses the larger or the smaller cue, or the one that differs more, or less, from
/// the usual one. With three, it chooses the odd one. For same or different, it uses a criterion or a band of
/// the difference. Cues that differ by less than a thousandth (0.01 dB of loudness) count as equal. The last
/// report is for an observer without a cue, who always presses the key that is right most often.
/// If a procedure chooses levels by the answers, each level that it can present counts equally often. If it
/// follows right answers, the observer also does simulated sessions with the same rule, so that its own
/// answers set the levels: as many sessions as needed to bring three standard errors to 1 %, at most 1000. A
/// rule that is equally good at every level, within 2 %, needs no sessions, because its accuracy does not
/// depend on the levels. The larger gain over chance is reported. If the procedure follows one of two answers
/// (`tracks`), such sessions say nothing, because the share of that answer converges on the target in any
/// case.
/// Duration is measured at half the amplitude: of two equally long intervals, the one with the longer ramps
/// is shorter.
CueGuard cue_guard(const protocol::Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey,
                   const std::stop_token& stop = {});

}  // namespace turnpoint::simulation

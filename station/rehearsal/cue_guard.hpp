#pragma once
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "station/protocol/survey.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::rehearsal {

/// How a long computation shows its progress, and how it is stopped early with a result.
struct Steps {
  /// called after each unit of work, from one thread at a time; `what` names the units; may be empty
  std::function<void(const char* what, int done, int of)> progress;
  std::stop_token finish;  ///< once requested, the work ends at its next whole unit

  std::function<void(int done, int of)> counted(const char* what) const {
    if (!progress) return {};
    return [this, what](int done, int of) { progress(what, done, of); };
  }
};

struct Reached {
  double accuracy = 0;  ///< proportion correct of the observer who uses the cue
  /// the proportion correct that an observer reaches in the same trials without the cue, by guessing or by
  /// always pressing the same key
  double chance = 0;
  /// three standard errors of `accuracy` or of `chance`, whichever is larger, or half the range of accuracies
  /// over the levels; 0 if the accuracy is exact
  double error = 0;

  double gain() const { return accuracy - chance; }
};

/// The accuracy of an observer who uses only one cue. If a cue gives far more right answers than chance,
/// either the task asks about this cue, or the cue gives the answers away.
struct CueReport {
  std::string cue;           ///< "pitch", "loudness", "amplitude at the wide end", ...
  double low = 0, high = 0;  ///< lowest and highest value of the cue in the main trials, in `unit`
  std::string unit;
  double accuracy = 0, chance = 0.5, error = 0;  ///< see the members of Reached
  /// The result of simulated sessions in which this observer's answers set the levels; empty if they would
  /// say nothing (see cue_guard()). `accuracy`, `chance` and `error` above are taken either from this result
  /// or from presenting all levels equally often, whichever gives the larger gain over chance. For the
  /// observer without a cue, they are taken from this result.
  std::optional<Reached> whole_sessions = {};
  std::string task = {};  ///< the task, if the file has several

  /// True if the cue clearly helps. A gain of 0.1 over a chance of 0.5 is two standard errors in 100 trials.
  bool above_chance() const { return accuracy > chance + 0.1; }
};

struct CueGuard {
  /// one report per cue and task; if a task has none, one of the next two members says why
  std::vector<CueReport> reports;
  /// why the task has no right answers that a cue could give away; otherwise ""
  std::string nothing_to_tell;
  /// which trials could not be planned or interpolated; if not empty, no cue of their task was examined
  std::string not_compared;
  bool stopped = false;  ///< true if `finish` was requested; `reports` then has the cues compared until then
};

/// Compares everything that the main trials present: standard and target, as they occur together in a trial.
/// Each kind of trial is weighted by its frequency (trial_census.hpp). Catch trials are included, practice is
/// left out. Orders of intervals and drawn factors have their exact probabilities. Roving is sampled with two
/// sets of at most 256 draws per trial: the first set chooses the rule, the second measures its accuracy.
///
/// The observer knows the task and the best rule for these trials:
/// - One interval: a criterion or a band of the cue at the end of the interval; with more than two answers,
///   neighbouring ranges of the cue, at most one more than there are answers. If the interval has two
///   scenes, the cue at its start and the change of the cue are tried as well.
/// - Two intervals: the observer chooses the larger or the smaller cue, or the cue that differs more, or
///   less, from its usual value.
/// - Three or four intervals: the observer chooses the largest or smallest cue, or the one that is most or
///   least unlike the others.
/// - ABX and match-to-sample: the observer chooses the interval that is most or least like X.
/// - Same or different: a criterion or a band of the difference.
///
/// Cues that differ by less than a thousandth (0.01 dB of loudness) count as equal. The last report is for an
/// observer without a cue, who always presses the key that is right most often.
///
/// If a procedure chooses levels from the answers, each level that the procedure can present counts equally
/// often. In two cases the observer also does simulated sessions with the same rule, so that the observer's
/// own answers set the levels, and the larger gain over chance is reported:
/// - The procedure follows right answers.
/// - The procedure follows the answer "yes" and chooses between levels with a signal and levels without.
///   There the answers also decide how often each answer is right, so the best rule is not known beforehand.
///   Many rules compete in such sessions (see cue_search.hpp), and the winner is judged in other sessions.
/// If the procedure follows one of two answers of another kind (`tracks`), no sessions are simulated: the
/// share of that answer would always converge on the target and reveal nothing. The observer without a cue
/// has sessions of its own for every procedure that follows answers, one set for each key, and only they
/// count.
///
/// Sessions are added until three standard errors are at most 1 %, up to 1000 sessions (6000 in a task with
/// one interval). A rule that is equally good at every level, within 2 %, needs no sessions, because its
/// accuracy does not depend on the levels.
///
/// Duration is measured at half the amplitude: of two equally long intervals, the one with the longer ramps
/// is shorter.
///
/// Throws protocol::Abandoned soon after `stop` is requested.
CueGuard cue_guard(const protocol::Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey,
                   const std::stop_token& stop = {}, const Steps& steps = {});

}  // namespace turnpoint::rehearsal

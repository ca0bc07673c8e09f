#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// One trial in a plot of levels over trials: the level that the procedure presented, and the answer.
struct TracePoint {
  int trial_index = 0;
  double level = 0;
  std::optional<bool> correct;
  std::optional<int> response;
};
struct Trace {
  std::string procedure;
  std::vector<TracePoint> points;
};
/// Returns one trace (the levels and answers in the order of the trials) per procedure, in the order in which
/// the procedures first occur. Includes only experimental trials with a level.
std::vector<Trace> traces(const std::vector<TrialRecord>& trials);

/// How often one of two choices (left/right, first/second) was preferred.
struct Bias {
  int answered = 0, second_choice = 0;
  double share_second = 0;
  Interval interval;  ///< Wilson interval of `share_second`
  /// criterion c with the log-linear correction (signal_detection.hpp); positive if the second choice is
  /// avoided
  std::optional<double> criterion;
  std::vector<Statement> statements;
};
/// Computes the bias from answered experimental trials with response 0 or 1; empty if there are none. Adds a
/// statement if `interval` does not contain the proportion of trials in which the second choice was right.
std::optional<Bias> choice_bias(const std::vector<TrialRecord>& trials);

struct Proportion {
  int right = 0, trials = 0;
  double value = 0;
  Interval interval;  ///< Clopper-Pearson interval of right / trials
};
/// Returns right / trials with its interval; `trials` must be above 0.
Proportion proportion(int right, int trials);

/// Returns the proportion of catch trials answered correctly. Timeouts and anticipations do not count as
/// answers. Empty if no catch trial was answered.
std::optional<Proportion> catch_accuracy(const std::vector<TrialRecord>& trials);
/// Returns the proportion of right answers for each degree of confidence that occurs in answered experimental
/// trials with a score.
std::map<int, Proportion> accuracy_by_confidence(const std::vector<TrialRecord>& trials);

/// A linear trend over the session. Its 95 % interval assumes a normally distributed estimate.
struct Trend {
  double per_100_trials = 0;
  Interval interval;
};
struct Fatigue {
  std::optional<Trend> response_time_s, proportion_correct;
  std::vector<Statement> statements;
};
/// Computes the trends of response time and accuracy over the experimental trials. Level and instruction are
/// controlled for: from each value, the mean of the trials with the same level and instruction is subtracted.
/// Empty with fewer than 20 answered trials.
Fatigue fatigue(const std::vector<TrialRecord>& trials);

/// Post-error slowing in s, robust against drifts over a session (Dutilh et al. 2012, J. Math. Psychol.
/// 56:208-216): the mean of the response time after an error minus that before the same error, with a 95 %
/// interval by Student's t. Takes runs of four experimental trials of one block and condition that follow each
/// other without a gap: right, right, wrong, right. Empty with fewer than 3 such runs. `trials` are in the
/// order of presentation.
std::optional<Estimate> post_error_slowing(const std::vector<TrialRecord>& trials,
                                           const std::string& condition);

/// How much more often a condition's answers repeat the answer of the previous trial than the right answers do
/// (a share from -1 to 1, with a 95 % interval by Student's t): above 0 for people who repeat themselves,
/// below 0 for those who alternate, whatever the order of the stimuli. Takes pairs of answered experimental
/// trials of one block and condition that follow each other. Empty with fewer than 20 pairs. `trials` are in
/// the order of presentation.
std::optional<Estimate> repetition(const std::vector<TrialRecord>& trials, const std::string& condition);

struct OutcomeCounts {
  int presented = 0, answered = 0, timeouts = 0, anticipations = 0, aborted = 0, faults = 0;
  int unsure = 0;  ///< answered trials in which the participant did not want to guess
};
/// Counts trials by outcome. Practice is left out.
OutcomeCounts count_outcomes(const std::vector<TrialRecord>& trials);

}  // namespace turnpoint::analysis

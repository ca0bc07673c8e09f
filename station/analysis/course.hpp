#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// The levels that a procedure presented, in order, for plotting an adaptive trace.
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
/// One trace per procedure, in the order of first occurrence. Only experimental trials with a level are
/// included.
std::vector<Trace> traces(const std::vector<TrialRecord>& trials);

/// The preference for one of two choices: left/right, first/second.
struct Bias {
  int answered = 0, second_choice = 0;
  double share_second = 0;
  Interval interval;                ///< Wilson interval of the share
  std::optional<double> criterion;  ///< c, log-linear; positive if the second choice is avoided
  std::vector<Statement> statements;
};
/// Computed from answered experimental trials with response 0 or 1; empty if there are none. Adds a statement
/// if the share's interval excludes the share of trials on which the second choice was right.
std::optional<Bias> choice_bias(const std::vector<TrialRecord>& trials);

struct Proportion {
  int right = 0, trials = 0;
  double value = 0;
  Interval interval;  ///< Clopper-Pearson interval
};
/// Proportion of catch trials answered correctly. Timeouts and anticipations do not count as answers. Empty
/// if there are none.
std::optional<Proportion> catch_accuracy(const std::vector<TrialRecord>& trials);

/// A linear trend over the session with its 95 % interval (normal theory).
struct Trend {
  double per_100_trials = 0;
  Interval interval;
};
struct Fatigue {
  std::optional<Trend> response_time_s, proportion_correct;
  std::vector<Statement> statements;
};
/// Trends of response time and accuracy over experimental trials. Level and instruction are controlled for:
/// each value is taken relative to the mean of trials with equal level and instruction. Empty with fewer than
/// 20 answered trials.
Fatigue fatigue(const std::vector<TrialRecord>& trials);

struct OutcomeCounts {
  int presented = 0, answered = 0, timeouts = 0, anticipations = 0, aborted = 0, faults = 0;
};
OutcomeCounts count_outcomes(const std::vector<TrialRecord>& trials);  ///< without practice trials

}  // namespace turnpoint::analysis

#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Levels that a procedure presented, in order: what an adaptive trace draws.
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
/// One trace a procedure, in the order first met; experimental trials with a level only.
std::vector<Trace> traces(const std::vector<TrialRecord>& trials);

/// Which of two choices is preferred: left/right, first/second.
struct Bias {
  int answered = 0, second_choice = 0;
  double share_second = 0;
  Interval interval;                ///< Wilson, of the share
  std::optional<double> criterion;  ///< c, log-linear; positive: the second choice is avoided
  std::vector<Statement> statements;
};
/// Of answered experimental trials with response 0 or 1; none where there is none. Says so where the share's
/// interval excludes the share of trials on which the second choice was right.
std::optional<Bias> choice_bias(const std::vector<TrialRecord>& trials);

struct Proportion {
  int right = 0, trials = 0;
  double value = 0;
  Interval interval;  ///< Clopper-Pearson
};
/// Catch trials answered right; timeouts and anticipations are not answers. None without any.
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
/// Trends of response time and accuracy over experimental trials, level and instruction taken out (deviations
/// from the mean of equal level and instruction). None with fewer than 20 answered trials.
Fatigue fatigue(const std::vector<TrialRecord>& trials);

struct OutcomeCounts {
  int presented = 0, answered = 0, timeouts = 0, anticipations = 0, aborted = 0, faults = 0;
};
OutcomeCounts count_outcomes(const std::vector<TrialRecord>& trials);  ///< practice left out

}  // namespace turnpoint::analysis

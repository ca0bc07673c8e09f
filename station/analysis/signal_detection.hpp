#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Sensitivity in two-alternative forced choice of interval or place: sqrt(2) z(Pc) (Green & Swets 1966).
/// Empty for a proportion of 0 or 1, where it is not finite; use the log-linear counts there.
std::optional<double> d_prime_forced_choice(double proportion_correct);

/// Answers of a yes/no task, or of a two-answer task with one answer counted as "yes".
struct YesNoCounts {
  int hits = 0, misses = 0, false_alarms = 0, correct_rejections = 0;
};

/// Sensitivity d' = z(H) - z(F) and criterion c = -(z(H) + z(F)) / 2 (positive if "yes" is avoided).
struct YesNo {
  double d_prime = 0, criterion = 0;
  double hit_rate = 0, false_alarm_rate = 0;  ///< with the log-linear correction
};

/// Always applies the log-linear correction (Hautus 1995), 0.5 added to each count and 1 to each total, so
/// that the estimate is finite for perfect rates too. Empty if one of the two stimuli was never presented.
std::optional<YesNo> yes_no(const YesNoCounts& counts);

/// How sensitivity is measured from answers of which one is counted as "yes".
enum class Detecting {
  presence,  ///< trials without a signal are the noise for every level (yes/no)
  sides,     ///< at each |level| one side is the signal, the other the noise (left/right)
  /// like `sides`, by place or interval; d' is divided by sqrt(2) (Macmillan & Creelman 2005)
  forced_choice,
};

/// The yes/no analysis of one condition at one level, or at all of them.
struct Detection {
  std::string condition;
  std::optional<double> level;  ///< |level|; empty for all levels together
  YesNoCounts counts;
  /// Empty if there was no signal or no noise. 95 % intervals by the variance of Gourevitch & Galanter (1967)
  /// at the corrected rates.
  std::optional<Estimate> d_prime, criterion;
};

/// Analyses answered experimental trials that have a right answer. For each condition, in this order, it
/// returns the levels ascending, then all levels together. With more than `most_levels` levels, as after an
/// adaptive procedure, it returns only all levels together. `positive` is the choice that means "yes".
std::vector<Detection> detect(const std::vector<TrialRecord>& trials, const std::vector<std::string>& order,
                              Detecting detecting, int positive, std::size_t most_levels = 8);

struct RocPoint {
  double false_alarms = 0, hits = 0;
};

/// A receiver operating characteristic from ratings.
struct Roc {
  std::vector<RocPoint> points;  ///< from (0, 0) to (1, 1), beginning with the strictest criterion
  /// area under straight lines between the points; 95 % interval by Hanley & McNeil (1982)
  Estimate area;
};

/// `noise` and `signal` are numbers of trials by rating, from the surest no to the surest yes. Empty if one
/// of them has no trials. Throws std::invalid_argument for fewer than 2 ratings, lists of different length,
/// or negative counts.
std::optional<Roc> roc(const std::vector<int>& noise, const std::vector<int>& signal);

/// Proportion correct with the log-linear correction, (k + 0.5) / (n + 1); empty for n = 0.
std::optional<double> log_linear_proportion(int successes, int trials);

}  // namespace turnpoint::analysis

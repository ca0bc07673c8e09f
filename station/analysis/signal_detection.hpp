#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/rating_fit.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Counts the answers of a yes/no task, or of a two-answer task in which one answer counts as "yes".
struct YesNoCounts {
  int hits = 0, misses = 0, false_alarms = 0, correct_rejections = 0;
};

/// Sensitivity d' = z(H) - z(F) and criterion c = -(z(H) + z(F)) / 2, from hit rate H and false-alarm rate F.
/// c is positive if the observer says "yes" too rarely.
struct YesNo {
  double d_prime = 0, criterion = 0;
  double hit_rate = 0, false_alarm_rate = 0;  ///< both rates with the log-linear correction
};

/// Computes sensitivity and criterion. The log-linear correction (Hautus 1995) is always applied: it adds 0.5
/// to each count and 1 to each total, so that perfect rates also give finite estimates. Empty if there were
/// no signal trials or no noise trials.
std::optional<YesNo> yes_no(const YesNoCounts& counts);

/// Which trials count as signal and which as noise, when one answer is counted as "yes".
enum class Detecting {
  presence,  ///< yes/no: trials without a signal are the noise, for every level
  /// left/right: for each absolute value of the level, one side is the signal and the other side is the noise
  sides,
  /// like `sides`, for a choice between places or intervals; d' is divided by sqrt(2) (Macmillan & Creelman
  /// 2005)
  forced_choice,
};

/// Sensitivity and criterion in one condition, at one level or over all levels.
struct Detection {
  std::string condition;
  std::optional<double> level;  ///< absolute value of the level; empty for all levels together
  YesNoCounts counts;
  /// Empty if there were no signal trials or no noise trials. The 95 % intervals use the variance of
  /// Gourevitch & Galanter (1967) at the corrected rates.
  std::optional<Estimate> d_prime, criterion;
};

/// Analyses answered experimental trials that have a right answer. The results come in the order of
/// conditions_of(). Each condition has one result per level, ascending, followed by one for all levels
/// together. With more than `most_levels` levels, as after an adaptive procedure, the results per level are
/// left out. `positive` is the choice that means "yes".
std::vector<Detection> detect(const std::vector<TrialRecord>& trials, const std::vector<std::string>& order,
                              Detecting detecting, int positive, std::size_t most_levels = 8);

struct RocPoint {
  double false_alarms = 0, hits = 0;
};

/// A receiver operating characteristic from ratings.
struct Roc {
  /// points of the curve from (0, 0) to (1, 1), beginning with the strictest criterion
  std::vector<RocPoint> points;
  /// area under straight lines between the points; 95 % interval by method 5 of Newcombe (2006)
  Estimate area;
};

/// Computes the curve from the numbers of noise and signal trials by rating, from the surest "no" to the
/// surest "yes". Empty if there are no noise trials or no signal trials. Throws std::invalid_argument for
/// fewer than 2 ratings, lists of different length, or negative counts.
std::optional<Roc> roc(const std::vector<int>& noise, const std::vector<int>& signal);

/// The ROC of ratings, at one level or over all levels. A rating is a point of a scale, or an answer "yes" or
/// "no" together with its confidence.
struct RatedDetection {
  std::string condition;
  std::optional<double> level;     ///< absolute value of the level; empty for all levels together
  std::vector<int> noise, signal;  ///< numbers of trials, from the surest "no" to the surest "yes"
  Roc roc;
  /// the normal model with equal variances, and with a variance of its own for the signal; empty if the
  /// answers do not determine it
  std::optional<RatingFit> equal, unequal;
};

/// Computes the curves of answered experimental trials that have a right answer and a confidence. Conditions,
/// levels, `positive` and `most_levels` are as for detect() with Detecting::presence: all levels share the
/// noise. Levels without noise trials or without signal trials are left out.
std::vector<RatedDetection> rocs(const std::vector<TrialRecord>& trials,
                                 const std::vector<std::string>& order, int positive,
                                 std::size_t most_levels = 8);

/// Like rocs(), for ratings from the surest "no" (response 0) to the surest "yes" (response points - 1), of
/// trials of which it is known whether they had a signal (TrialRecord::present).
std::vector<RatedDetection> rating_rocs(const std::vector<TrialRecord>& trials,
                                        const std::vector<std::string>& order, int points,
                                        std::size_t most_levels = 8);

/// Returns the proportion correct with the log-linear correction, (k + 0.5) / (n + 1); empty for n = 0.
std::optional<double> log_linear_proportion(int successes, int trials);

}  // namespace turnpoint::analysis

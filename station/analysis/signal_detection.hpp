#pragma once
#include <optional>

namespace turnpoint::analysis {

/// Sensitivity in two-alternative (interval or place) forced choice, sqrt(2) z(Pc) (Green & Swets 1966). None
/// for a proportion of 0 or 1, where it is not finite; use the log-linear counts there.
std::optional<double> d_prime_forced_choice(double proportion_correct);

/// Single-interval two-answer (left/right): 2 z(Pc), right for a symmetric observer without bias only.
std::optional<double> d_prime_single_interval_unbiased(double proportion_correct);

/// Answers of a yes/no task, or of a two-answer task with one answer taken as "yes".
struct YesNoCounts {
  int hits = 0, misses = 0, false_alarms = 0, correct_rejections = 0;
};

/// Sensitivity d' = z(H) - z(F) and criterion c = -(z(H) + z(F)) / 2 (positive: "yes" is avoided).
struct YesNo {
  double d_prime = 0, criterion = 0;
  double hit_rate = 0, false_alarm_rate = 0;  ///< after the correction
};

/// With the log-linear correction (Hautus 1995): 0.5 added to each count and 1 to each total, always, so that
/// the estimate is finite for perfect rates too. None where one of the two stimuli never came.
std::optional<YesNo> yes_no(const YesNoCounts& counts);

/// Proportion correct with the log-linear correction, (k + 0.5) / (n + 1); none for n = 0.
std::optional<double> log_linear_proportion(int successes, int trials);

}  // namespace turnpoint::analysis

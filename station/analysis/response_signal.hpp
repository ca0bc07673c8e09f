#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/signal_detection.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Sensitivity at one lag of the response signal.
struct LagPoint {
  double lag_s = 0;  ///< time of the response signal, counted from the zero of response times (response_zero)
  double time_s = 0;  ///< mean response time, counted from the same zero
  YesNoCounts counts;
  std::optional<Estimate> d_prime;  ///< sensitivity as in Detection; empty if a stimulus has no answers
};

/// How sensitivity grows with time: d'(t) = asymptote (1 - exp(-rate (t - intercept))) after the intercept,
/// and 0 before (Wickelgren 1977, Acta Psychol. 41:67-85).
struct SpeedAccuracyCurve {
  std::string condition;
  std::vector<LagPoint> points;  ///< ascending by lag
  /// The most probable values and their 95 % profile intervals. Priors: the asymptote is half-normal with SD
  /// 1.8 (0 to 8), the logarithm of the rate normal around 3 per second with SD 1.5 (0.3 to 40 per second),
  /// the intercept uniform from 0 to the longest time_s. An end of an interval that the data do not determine
  /// is infinite. A parameter is empty if neither end is determined; a statement says so.
  std::optional<Estimate> asymptote, rate_per_s, intercept_s;
  /// d' of each absolute level at each lag, if there are two levels or more: in the order of `points`, then
  /// ascending; without the entries for all levels together
  std::vector<std::vector<Detection>> by_level;
  std::vector<Statement> statements;
  /// the height of the best curve with each value of asymptote, log rate and intercept, in nats above that of
  /// the parameter's own prior; empty without a fit
  std::array<std::vector<double>, 3> profiles;
};

/// How the curve differs between two conditions. The intervals come from those of the two curves (MOVER;
/// Donner & Zou 2002); an end is infinite if an end of these is. Empty if a curve lacks the parameter. The p
/// values compare nested models: that with one asymptote (rate, intercept) for both curves and everything else
/// free, against two curves of their own, by chi squared with one degree of freedom for twice the difference
/// of the heights. Empty if a curve was not fitted.
struct CurveDifference {
  std::string first, second;
  std::optional<Estimate> asymptote, intercept_s;  ///< second minus first
  std::optional<Estimate> rate_ratio;              ///< second divided by first
  std::array<std::optional<double>, 3> p, corrected_p = {};  ///< asymptote, rate, intercept; by holm()
};

/// Returns the sensitivity d'(t) at a time on the curve with these three parameters.
double d_prime_at(double asymptote, double rate_per_s, double intercept_s, double time_s);

/// Fits the curve to answered experimental trials with a right answer and a lag (TrialRecord::signal_s). Each
/// lag has a criterion of its own. `positive` is the choice that counts as "yes". One curve for each
/// condition that has such trials, first those in `order`.
std::vector<SpeedAccuracyCurve> response_signal(const std::vector<TrialRecord>& trials,
                                                const std::vector<std::string>& order, Detecting detecting,
                                                int positive);

/// The answers at one lag that unlimited trials would give: the mean time of the answers, the numbers of
/// trials with and without a signal (or any numbers in their ratio), and the probability of "yes" in them.
struct ExpectedLag {
  double time_s = 0, signals = 0, yes_with = 0, noises = 0, yes_without = 0;
};
/// Asymptote, rate per s and intercept in s of the most likely curve through such answers: what
/// response_signal() comes to with ever more trials, when its priors no longer matter. Empty with fewer than 3
/// lags.
std::optional<std::array<double, 3>> limiting_curve(const std::vector<ExpectedLag>& lags,
                                                    Detecting detecting);

/// One entry for each pair of curves; the earlier one is `first`.
std::vector<CurveDifference> curve_differences(const std::vector<SpeedAccuracyCurve>& curves);

}  // namespace turnpoint::analysis

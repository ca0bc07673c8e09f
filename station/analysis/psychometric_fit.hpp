#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "station/analysis/psychometric_function.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// A level below every other level, on every scale.
constexpr double kNoise = -std::numeric_limits<double>::infinity();

/// The number of answers at one level, and how many of them were the predicted one (correct, or the tracked
/// answer).
struct LevelCount {
  double level = 0;  ///< kNoise for trials without a signal, where the probability is the lower asymptote
  int trials = 0;
  int positive = 0;
};

/// How the lower asymptote is determined: given (1/alternatives), estimated within bounds, or equal to the
/// lapse rate (for two answers on a signed level, where a slip can go either way). If there are trials
/// without a signal, an estimated asymptote is the rate of false alarms.
enum class Guess { fixed, fitted, tied_to_lapse };

struct FitOptions {
  Function function = Function::weibull;
  Scale scale = Scale::linear;
  Guess guess = Guess::fixed;
  double guess_value = 0.5;                     ///< used by Guess::fixed
  double guess_low = 0, guess_high = 0.5;       ///< used by Guess::fitted
  double lapse_low = 0, lapse_high = 0.06;      ///< the lapse rate is fixed if both are equal
  int minimum_levels = 3, minimum_trials = 15;  ///< with less data there is no fit but a statement
};

/// Marks estimates that lie on a bound. Such a number is a limit, not an estimate.
struct AtBound {
  bool slope_low = false, slope_high = false, lapse_low = false, lapse_high = false, guess = false;
};

/// A maximum-likelihood fit. If nothing can be estimated, `parameters` is empty and `statements` say why.
struct PsychometricFit {
  FitOptions options;
  std::vector<LevelCount> data;  ///< one entry per level, ascending, without levels that have no trials
  std::optional<Psychometric> parameters;
  AtBound at_bound;
  double negative_log_likelihood = 0;  ///< of the single answers, in nats; without binomial coefficients
  double deviance = 0;                 ///< relative to the saturated model (one proportion per level)
  int free_parameters = 0;
  std::vector<Statement> statements;
};

/// Fits by Fisher scoring within bounds from several starts. The threshold stays within one range of the
/// levels around them. Refuses with a statement if there are too few levels or trials, all or none of the
/// answers are positive, the answers do not rise with the level (reversed), or the threshold is beyond its
/// bounds. Adds a statement if an estimate lies on a bound, the threshold is extrapolated, or the function is
/// a step. Throws std::invalid_argument for counts or options that make no sense.
PsychometricFit fit_psychometric(const std::vector<LevelCount>& data, const FitOptions& options);

struct ParameterInterval {
  Interval interval;
  bool touches_low = false, touches_high = false;  ///< an end lies on a bound: the data do not limit it
};

/// The prior. Threshold: from low to high on the function's axis, in the unit of the level. Slope: its
/// logarithm from low to high, as in Psychometric. Both densities are flat, except that over `falling_share`
/// of the range at either end they fall linearly to 0.
struct Prior {
  double threshold_low = 0, threshold_high = 1;
  double slope_low = 0, slope_high = 1;
  double falling_share = 0;  ///< 0 to 0.5
};

enum class IntervalMethod { none, bootstrap, posterior };

/// The 95 % intervals of a fit, by a bootstrap (if levels were fixed before the session) or from a posterior
/// (if levels depended on the answers). A quantity that the data do not determine is empty, and a statement
/// says so.
struct PsychometricIntervals {
  IntervalMethod method = IntervalMethod::none;
  int replicates = 0;          ///< for a bootstrap
  std::optional<Prior> prior;  ///< for a posterior
  double confidence = 0.95;
  std::optional<ParameterInterval> threshold, slope, lapse, guess;
  /// level at which the fitted probability is 0.75, if there is one
  std::optional<double> level_75;
  std::optional<ParameterInterval> interval_75;         ///< interval of level_75
  std::optional<double> deviance_p;                     ///< for a bootstrap
  std::vector<double> band_level, band_low, band_high;  ///< probability at `band_level`
  std::vector<Statement> statements;
};

struct BootstrapOptions {
  int replicates = 1000;
  double confidence = 0.95;
  std::uint64_t seed = 1;
  int stream = 0;        ///< number of the fit: gives each fit of a session different random draws
  int band_points = 61;  ///< 0: no band
};

/// Parametric bootstrap of a fit (Wichmann & Hill 2001b).
/// Intervals of threshold, slope and 75 % point are profile-likelihood intervals. Their critical value is
/// taken from the likelihood ratios of the replicates instead of chi-square. Plain percentile intervals of a
/// slope would miss one time in seven with ten trials a level, because the estimate is biased; BCa intervals
/// of a Weibull's threshold are no better. Lapse and guess have percentile intervals.
/// Use this only if the levels were fixed before the session. If a procedure chose them by the answers, these
/// intervals are too short: use fit_posterior().
/// Deterministic for a seed and stream. The result is empty, with a statement, if the fit has no parameters.
PsychometricIntervals bootstrap(const PsychometricFit& fit, const BootstrapOptions& options);

/// Counts by level. count_correct() uses answered trials that have a level and a score (`correct`); the other
/// function uses those with a response, and counts `positive_choice`. Practice, catch and warm-up trials are
/// left out.
std::vector<LevelCount> count_correct(const std::vector<TrialRecord>& trials);
std::vector<LevelCount> count_choice(const std::vector<TrialRecord>& trials, int positive_choice);

}  // namespace turnpoint::analysis

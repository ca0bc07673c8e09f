#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "station/analysis/psychometric_function.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Below every level, on every scale.
constexpr double kNoise = -std::numeric_limits<double>::infinity();

/// Answers at one level: how many, and how many of them were the one that the function predicts (correct, or
/// the tracked answer).
struct LevelCount {
  double level = 0;  ///< kNoise: trials without a signal, whose probability is the lower asymptote
  int trials = 0;
  int positive = 0;
};

/// What the lower asymptote is: given (1/alternatives), estimated within bounds, or equal to the lapse rate
/// (two answers on a signed level, where a slip may go either way). Estimated means the rate of false alarms
/// where there are trials without a signal.
enum class Guess { fixed, fitted, tied_to_lapse };

struct FitOptions {
  Function function = Function::weibull;
  Scale scale = Scale::linear;
  Guess guess = Guess::fixed;
  double guess_value = 0.5;                     ///< for Guess::fixed
  double guess_low = 0, guess_high = 0.5;       ///< for Guess::fitted
  double lapse_low = 0, lapse_high = 0.06;      ///< equal: fixed
  int minimum_levels = 3, minimum_trials = 15;  ///< below: no fit, but a statement
};

/// Which estimates stand on a bound, where the number is not an estimate but a limit.
struct AtBound {
  bool slope_low = false, slope_high = false, lapse_low = false, lapse_high = false, guess = false;
};

/// A maximum-likelihood fit. Where nothing can be estimated `parameters` is none and `statements` say why.
struct PsychometricFit {
  FitOptions options;
  std::vector<LevelCount> data;  ///< one entry a level, ascending, levels without trials removed
  std::optional<Psychometric> parameters;
  AtBound at_bound;
  double negative_log_likelihood = 0;  ///< of the single answers, nats; without binomial coefficients
  double deviance = 0;                 ///< against the saturated model (one proportion a level)
  int free_parameters = 0;
  std::vector<Statement> statements;
};

/// Fits by Fisher scoring within bounds from several starts. Threshold: within one range of the levels around
/// them. Refuses with a statement: too few levels or trials, all or none positive, answers that do not rise
/// with the level (reversed), a threshold beyond its bounds. Says so where an estimate stands on a bound, the
/// threshold is extrapolated, or the function is a step. Throws std::invalid_argument for counts or options
/// that make no sense.
PsychometricFit fit_psychometric(const std::vector<LevelCount>& data, const FitOptions& options);

struct ParameterInterval {
  Interval interval;
  bool touches_low = false, touches_high = false;  ///< an end stands on a bound: the data do not limit it
};

/// What is thought possible before the first answer. Threshold: from low to high on the function's axis, in
/// the unit of the level. Slope: its logarithm from low to high, as in Psychometric. The density of both is
/// flat but for this share of the range at either end, over which it falls linearly to 0.
struct Prior {
  double threshold_low = 0, threshold_high = 1;
  double slope_low = 0, slope_high = 1;
  double falling_share = 0;  ///< 0 to 0.5
};

enum class IntervalMethod { none, bootstrap, posterior };

/// The 95 % intervals of a fit, by a bootstrap (levels fixed before the session) or from a posterior (levels
/// chosen by the answers). What the data do not determine is none, and a statement says so.
struct PsychometricIntervals {
  IntervalMethod method = IntervalMethod::none;
  int replicates = 0;          ///< of a bootstrap
  std::optional<Prior> prior;  ///< of a posterior
  double confidence = 0.95;
  std::optional<ParameterInterval> threshold, slope, lapse, guess;
  std::optional<double> level_75;                ///< where the fitted probability is 0.75, if it is anywhere
  std::optional<ParameterInterval> interval_75;  ///< of that level
  std::optional<double> deviance_p;              ///< of a bootstrap
  std::vector<double> band_level, band_low, band_high;  ///< probability at `band_level`
  std::vector<Statement> statements;
};

struct BootstrapOptions {
  int replicates = 1000;
  double confidence = 0.95;
  std::uint64_t seed = 1;
  int stream = 0;        ///< tells fits of one session apart
  int band_points = 61;  ///< 0: no band
};

/// Parametric bootstrap (Wichmann & Hill 2001b) of a fit. Intervals of threshold, slope and 75 % point are
/// those of the profile likelihood, with the critical value of the likelihood ratio that the replicates show
/// instead of chi-square's: plain percentile intervals of a slope miss one time in seven with ten trials a
/// level, since its estimate is biased, and BCa intervals of a Weibull's threshold likewise. Lapse and guess
/// have percentile intervals. Only for levels that were fixed before the session: where a procedure chose
/// them by the answers these intervals are too short, and fit_posterior() is meant.
/// Deterministic for a seed and stream. An empty result with a statement where the fit has no parameters.
PsychometricIntervals bootstrap(const PsychometricFit& fit, const BootstrapOptions& options);

/// Counts by level of answered trials that have a level and a score (`correct`), or of those with a response,
/// counting `positive_choice`. Practice, catch and warm-up trials are left out.
std::vector<LevelCount> count_correct(const std::vector<TrialRecord>& trials);
std::vector<LevelCount> count_choice(const std::vector<TrialRecord>& trials, int positive_choice);

}  // namespace turnpoint::analysis

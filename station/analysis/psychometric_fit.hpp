#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "station/analysis/psychometric_function.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// The level of trials without a signal: it lies below every other level on every scale.
constexpr double kNoise = -std::numeric_limits<double>::infinity();

/// The number of answers at one level, and how many of them were positive. Depending on what is fitted, a
/// positive answer is a right answer or one particular choice.
struct LevelCount {
  double level = 0;  ///< kNoise for trials without a signal; their probability is the lower asymptote
  int trials = 0;
  int positive = 0;
  /// what guesses that were not made would have added to `positive` on average (count_correct()); only with
  /// Guess::fixed, whose value is then the share of such guesses that would have been right
  double admitted = 0;
  double sum() const { return positive + admitted; }
};

/// How the lower asymptote is determined: fixed (1 / alternatives), fitted within bounds, or tied to the
/// lapse rate. It is tied if the level is signed and there are two answers, because a slip then makes either
/// answer wrong. If there are trials without a signal, a fitted asymptote is the rate of false alarms.
enum class Guess { fixed, fitted, tied_to_lapse };

struct FitOptions {
  Function function = Function::weibull;
  Scale scale = Scale::linear;
  Guess guess = Guess::fixed;
  double guess_value = 0.5;                     ///< the lower asymptote, if it is fixed
  double guess_low = 0, guess_high = 0.5;       ///< bounds of the lower asymptote, if it is fitted
  double lapse_low = 0, lapse_high = 0.06;      ///< the lapse rate is fixed if both are equal
  int minimum_levels = 3, minimum_trials = 15;  ///< with fewer levels or trials, a statement replaces the fit
};

/// Marks estimates that lie on a bound. The data then give only a limit for the parameter, not an estimate.
struct AtBound {
  bool slope_low = false, slope_high = false, lapse_low = false, lapse_high = false, guess = false;
};

/// A maximum-likelihood fit. If nothing can be estimated, `parameters` is empty and `statements` say why.
struct PsychometricFit {
  FitOptions options;
  std::vector<LevelCount> data;  ///< one entry per level, ascending, without levels that have no trials
  std::optional<Psychometric> parameters;
  AtBound at_bound;
  /// How many forced answers an answer counts as: above 1 if the participant admitted guesses, because a mean
  /// scatters less than a guess. It is the binomial variance of the answers, divided by what is left of it;
  /// all log-likelihoods are multiplied by it (quasi-likelihood: Wedderburn 1974).
  double weight = 1;
  double negative_log_likelihood = 0;  ///< for the individual answers, in nats; without binomial coefficients
  /// deviance from the saturated model, which has one proportion per level
  double deviance = 0;
  int free_parameters = 0;
  std::vector<Statement> statements;
};

/// Fits by Fisher scoring within bounds, from several starting points. The threshold stays within the range
/// of the levels, extended by its own width at both ends. A statement replaces the fit if there are too few
/// levels or trials, if all or none of the answers are positive, if the answers become rarer as the level
/// rises (reversed), or if the threshold is beyond its bounds. A statement is added if an estimate lies on a
/// bound, the threshold is extrapolated, or the function is a step. Throws std::invalid_argument for
/// impossible counts or options.
PsychometricFit fit_psychometric(const std::vector<LevelCount>& data, const FitOptions& options);

struct ParameterInterval {
  Interval interval;
  /// true if this end of the interval is the bound of the parameter, so the data do not limit the interval
  bool touches_low = false, touches_high = false;
};

/// The prior of threshold and slope. The range of the threshold, from low to high, is in the unit of the
/// level; its density is defined on the function's axis. The density of the slope is defined on the logarithm
/// of the slope. Both densities are flat in the middle and fall linearly to 0 at both ends of the range.
struct Prior {
  double threshold_low = 0, threshold_high = 1;
  double slope_low = 0, slope_high = 1;
  double falling_share = 0;  ///< fraction of the range, at either end, in which the density falls; 0 to 0.5
};

enum class IntervalMethod { none, bootstrap, posterior };

/// The 95 % intervals of a fit. They come from a bootstrap if the levels were fixed before the session, and
/// from a posterior if the levels depended on the answers. If the data do not determine a quantity, its
/// interval is empty and a statement says so.
struct PsychometricIntervals {
  IntervalMethod method = IntervalMethod::none;
  int replicates = 0;          ///< number of resamples; set for a bootstrap only
  std::optional<Prior> prior;  ///< prior of the Bayesian fit; empty for a bootstrap
  double confidence = 0.95;
  std::optional<ParameterInterval> threshold, slope, lapse, guess;
  /// level at which the fitted probability is 0.75, if there is one
  std::optional<double> level_75;
  std::optional<ParameterInterval> interval_75;  ///< interval of level_75
  /// proportion of bootstrap replicates whose deviance is at least that of the fit
  std::optional<double> deviance_p;
  /// band of the fitted probability: its lower and upper end at each `band_level`
  std::vector<double> band_level, band_low, band_high;
  std::vector<Statement> statements;
};

struct BootstrapOptions {
  int replicates = 1000;
  double confidence = 0.95;
  std::uint64_t seed = 1;
  int stream = 0;  ///< number of the fit: gives each fit of a session different random draws
  /// number of levels at which the confidence band of the function is computed; 0: no band
  int band_points = 61;
};

/// Computes intervals by a parametric bootstrap of a fit (Wichmann & Hill 2001b).
///
/// Threshold, slope and 75 % point get profile-likelihood intervals. If values apart from each other are
/// likely enough, the interval reaches from the lowest to the highest. The critical value comes from the
/// likelihood ratios of the replicates instead of chi-square. Percentile intervals of the slope would be
/// worse: with ten trials per level they would miss the true value in 1 case of 7 instead of 1 of 20, because
/// the estimate is biased. BCa intervals of a Weibull's threshold are no better. Lapse and guess get
/// percentile intervals.
///
/// Use this only if the levels were fixed before the session. If a procedure chose the levels from the
/// answers, these intervals are too short: use fit_posterior().
///
/// The result depends only on fit and options, seed and stream included. If the fit has no parameters, the
/// result holds only a statement.
PsychometricIntervals bootstrap(const PsychometricFit& fit, const BootstrapOptions& options);

/// True if the positive answers become rarer as the level rises.
bool falls(const std::vector<LevelCount>& counts);

/// Counts answers by level. count_correct() uses the answered trials that have a level and a score
/// (`correct`), and those in which the participant was unsure, as 1 / alternatives of a right answer: the
/// mean of the guess that was not made (Kaernbach 2001). count_choice() uses those that have a level and a
/// response, and counts `positive_choice`. Both leave out practice, catch and warm-up trials.
std::vector<LevelCount> count_correct(const std::vector<TrialRecord>& trials, int alternatives = 2);
std::vector<LevelCount> count_choice(const std::vector<TrialRecord>& trials, int positive_choice);

}  // namespace turnpoint::analysis

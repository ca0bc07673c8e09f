#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/psychometric_fit.hpp"

namespace turnpoint::analysis {

/// The answers of one participant. `guess` is the lower asymptote, which the fit takes as known; each answer
/// counts `weight` times (PsychometricFit::weight).
struct PersonCounts {
  std::string person;
  std::vector<LevelCount> counts;
  double guess = 0, weight = 1;
};

struct MixedOptions {
  Function function = Function::normal;
  Scale scale = Scale::linear;
  /// Bounds of the lapse rate, which all participants share. It is fixed if both are equal.
  double lapse_low = 0, lapse_high = 0.06;
  /// True if a slip makes either answer wrong (Guess::tied_to_lapse): the lower asymptote of all participants
  /// is then the lapse rate, and PersonCounts::guess is ignored.
  bool tied_to_lapse = false;
};

/// The estimates of partial pooling for one participant.
struct PooledPerson {
  std::string person;
  int trials = 0;
  Psychometric parameters;            ///< at the mode of the participant's random effects
  std::optional<Estimate> threshold;  ///< 95 % interval; empty if the function does not rise
  /// How far the prediction is drawn towards the group: 0 leaves the participant's own data as they are, 1
  /// replaces them by the group.
  double shrinkage = 0;
};

/// A psychometric function with random effects: participant i answers with the probability guess + (1 - guess
/// - lapse) sigmoid(b0 + b0i + (b1 + b1i) u), where u is the level's axis_position() and (b0i, b1i) are normal
/// with mean 0 and any covariance (Moscatelli, Mezzetti & Lacquaniti 2012). In the notation of lme4:
/// `cbind(positive, trials - positive) ~ u + (1 + u | participant)`.
struct MixedFit {
  MixedOptions options;
  double intercept = 0, rate = 0;        ///< b0 and b1
  double intercept_se = 0, rate_se = 0;  ///< standard errors of b0 and b1
  double intercept_sd = 0, rate_sd = 0;  ///< standard deviations of b0i and b1i
  double correlation = 0;                ///< correlation of b0i and b1i; 0 if one of them does not vary
  double lapse = 0;
  double log_likelihood = 0;                 ///< for the individual answers, by Laplace's approximation
  std::optional<Estimate> threshold, slope;  ///< for the group, with 95 % intervals
  /// Standard deviation of the participants' thresholds, in the unit of the level (at the group's threshold).
  std::optional<double> threshold_sd;
  std::vector<PooledPerson> persons;  ///< in the order of the data
  std::vector<Statement> statements;
};

/// Fits by maximum likelihood. The random effects are integrated out by Laplace's approximation, as lme4 does
/// by default. The intervals of the group use Student's t with one degree of freedom less than there are
/// participants. The intervals of participants include the uncertainty of the group's parameters (Morris
/// 1983) and that of the random effects' covariance, over draws from its likelihood. `fit` is empty, and
/// `statements` give the reason, with fewer than 3 participants who have answers, or if the answers do not
/// determine the function.
///
/// Takes about 0.2 s for 20 participants with 10 levels each, and three times as long if the lapse rate is
/// fitted.
struct MixedResult {
  std::optional<MixedFit> fit;
  std::vector<Statement> statements;  ///< why `fit` is empty
};
MixedResult fit_mixed(const std::vector<PersonCounts>& data, const MixedOptions& options);

}  // namespace turnpoint::analysis

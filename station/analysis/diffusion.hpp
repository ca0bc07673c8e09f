#pragma once
#include <optional>
#include <vector>

#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Scaling parameter of the diffusion: all drifts and boundaries in this header assume s = 0.1.
constexpr double kDiffusionScale = 0.1;

/// The input of EZ-diffusion for the trials of one difficulty under one instruction. Mean and variance are
/// those of the response times of correct answers.
struct EzMoments {
  double proportion_correct = 0;
  double variance_s2 = 0, mean_s = 0;
  int trials = 0;  ///< number of answered trials
};

/// Drift rate v (per s), boundary separation a, and non-decision time Ter.
struct EzDiffusion {
  double drift = 0, boundary = 0, nondecision_s = 0;
};

struct EzResult {
  /// empty if they cannot be determined; a statement then gives the reason
  std::optional<EzDiffusion> parameters;
  std::vector<Statement> statements;
};

/// Solves the EZ-diffusion equations in closed form (Wagenmakers, van der Maas & Grasman 2007). A proportion
/// correct of 1 is replaced by 1 - 1/(2n). Within 1e-3 of chance the formula's limits are used. There is no
/// solution if the proportion is outside (0, 1), the variance is 0, or Ter would be negative.
EzResult ez_diffusion(const EzMoments& moments);

/// The diffusion parameters of several difficulties under one instruction. Boundary and Ter are shared; each
/// difficulty has its own drift.
struct SharedEz {
  double boundary = 0, nondecision_s = 0;
  /// Standard deviation of the estimate of ln(boundary), by the delta method. The kurtosis of the times is
  /// taken from the model. The kurtosis of a sample is far too low, so intervals from a bootstrap over trials
  /// would be too short.
  double log_boundary_sd = 0;
  std::vector<double> drift;  ///< one drift rate per difficulty, in the order of the moments passed in
};
struct SharedEzResult {
  std::optional<SharedEz> parameters;
  std::vector<Statement> statements;
};

/// Solves EZ's equations with a shared boundary and Ter. With L = logit(Pc), EZ gives the variance of the
/// decision time in one condition as (a / s)^4 h(L), where h is a known function. Each condition thus gives
/// an estimate of (a / s)^4. The result is the mean of these estimates, each weighted by the inverse of its
/// relative variance (delta method). The mean of their logarithms would be too low, by about half the
/// relative variance of one estimate. Ter is the weighted mean, over the conditions, of the mean time minus
/// the predicted decision time. Conditions with fewer than 10 correct answers are left out. With one
/// condition the result equals ez_diffusion().
SharedEzResult shared_ez_diffusion(const std::vector<EzMoments>& conditions);

}  // namespace turnpoint::analysis

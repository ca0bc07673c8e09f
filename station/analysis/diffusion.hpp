#pragma once
#include <optional>
#include <vector>

#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Scaling parameter of the diffusion: all drifts and boundaries in this header assume s = 0.1.
constexpr double kDiffusionScale = 0.1;

/// The input of EZ-diffusion for trials of one difficulty under one instruction. Times are of correct
/// answers.
struct EzMoments {
  double proportion_correct = 0;
  double variance_s2 = 0, mean_s = 0;
  int trials = 0;  ///< answered trials
};

/// Drift rate v (per s), boundary separation a, and non-decision time Ter.
struct EzDiffusion {
  double drift = 0, boundary = 0, nondecision_s = 0;
};

struct EzResult {
  std::optional<EzDiffusion> parameters;  ///< empty if not identifiable; a statement says why
  std::vector<Statement> statements;
};

/// EZ-diffusion in closed form (Wagenmakers, van der Maas & Grasman 2007). A proportion correct of 1 is
/// replaced by 1 - 1/(2n); within 1e-3 of chance the formula's limits are used. The model is not identifiable
/// if the proportion is outside (0, 1), the variance is 0, or Ter is negative.
EzResult ez_diffusion(const EzMoments& moments);

/// Several difficulties under one instruction: they share the boundary and Ter, and each has its own drift.
struct SharedEz {
  double boundary = 0, nondecision_s = 0;
  /// Standard deviation of the estimate of ln(boundary), by the delta method with the model's own kurtosis.
  /// The kurtosis of a sample is far too low, so the intervals of a bootstrap over trials would be too short.
  double log_boundary_sd = 0;
  std::vector<double> drift;  ///< in the order of the moments
};
struct SharedEzResult {
  std::optional<SharedEz> parameters;
  std::vector<Statement> statements;
};

/// EZ's equations with a shared boundary and Ter. With L = logit(Pc), the variance of a condition is (a /
/// s)^4 h(L), so each condition gives an estimate of (a / s)^4. The result is their mean, weighted by the
/// inverse relative variance (delta method). Averaging the logarithms instead would be biased low by half of
/// that variance. Ter follows from the means in the same way. Conditions with fewer than 10 correct answers
/// are left out. With one condition the result equals ez_diffusion().
SharedEzResult shared_ez_diffusion(const std::vector<EzMoments>& conditions);

}  // namespace turnpoint::analysis

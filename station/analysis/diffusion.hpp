#pragma once
#include <optional>
#include <vector>

#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Scaling parameter of the diffusion: all drifts and boundaries below are for s = 0.1.
constexpr double kDiffusionScale = 0.1;

/// What EZ-diffusion needs of trials of one difficulty under one instruction; times of correct answers.
struct EzMoments {
  double proportion_correct = 0;
  double variance_s2 = 0, mean_s = 0;
  int trials = 0;  ///< answered
};

/// Drift rate v (per s), boundary separation a, and time outside the decision Ter.
struct EzDiffusion {
  double drift = 0, boundary = 0, nondecision_s = 0;
};

struct EzResult {
  std::optional<EzDiffusion> parameters;  ///< none: not identifiable, a statement says why
  std::vector<Statement> statements;
};

/// EZ-diffusion in closed form (Wagenmakers, van der Maas & Grasman 2007). All correct becomes 1 - 1/(2n);
/// within 1e-3 of chance the limits are taken. Not identifiable: a proportion outside (0, 1), no variance, or
/// a negative Ter.
EzResult ez_diffusion(const EzMoments& moments);

/// One boundary and one Ter for several difficulties under one instruction, a drift for each.
struct SharedEz {
  double boundary = 0, nondecision_s = 0;
  /// Standard deviation of the estimate of ln(boundary), by the delta method with the model's own kurtosis: a
  /// sample's kurtosis is far too low, and with it the intervals of a bootstrap over trials.
  double log_boundary_sd = 0;
  std::vector<double> drift;  ///< in the order of the moments
};
struct SharedEzResult {
  std::optional<SharedEz> parameters;
  std::vector<Statement> statements;
};

/// EZ's equations with shared boundary and Ter: for L = logit(Pc) the variance of a condition is
/// (a / s)^4 h(L), so (a / s)^4 is the mean of what the conditions say, weighted by the inverse of its
/// relative variance (delta method; the mean of logarithms would come out low by half of that variance); Ter
/// likewise from the means. Conditions with fewer than 10 correct answers are left out. With one condition it
/// equals ez_diffusion().
SharedEzResult shared_ez_diffusion(const std::vector<EzMoments>& conditions);

}  // namespace turnpoint::analysis

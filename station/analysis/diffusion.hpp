#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Scaling parameter of the diffusion: all drifts and boundaries in this header assume s = 0.1.
constexpr double kDiffusionScale = 0.1;

/// Drift rate v (per s), boundary separation a, and non-decision time Ter.
struct DiffusionParameters {
  double drift = 0, boundary = 0, nondecision_s = 0;
};

/// Solves the EZ-diffusion equations in closed form (Wagenmakers, van der Maas & Grasman 2007) for the
/// proportion correct of `trials` answers and the mean and variance of the times of correct ones. A
/// proportion of 1 is replaced by 1 - 1/(2n). Empty if the equations have no solution. These moments suffer
/// from every time that is trimmed, late or not a decision, so fit_diffusion() uses the result as a start
/// value only.
std::optional<DiffusionParameters> ez_diffusion(double proportion_correct, int trials, double mean_s,
                                                double variance_s2);

/// What the fit knows of one presented trial.
struct DiffusionTrial {
  std::size_t difficulty = 0;  ///< index of the drift rate
  enum class Outcome { answered, late, early } outcome = Outcome::answered;
  bool correct = false;  ///< of an answer
  /// time of the answer; of a trial without an answer in time the deadline, and of an answer that came too
  /// early to be accepted the time from which answers are accepted
  double time_s = 0;
  std::optional<double> deadline_s;
  double early_s = 0;  ///< time from which answers are accepted
};

/// The parameters of one draw from the posterior distribution.
struct DiffusionDraw {
  double boundary = 0, nondecision_s = 0;
  double contaminants = 0;         ///< proportion of trials that were no decision
  double start = 0.5;              ///< relative start point, from wrong (0) to right (1)
  double drift_sd = 0;             ///< of the drift between trials, s = 0.1
  double nondecision_range_s = 0;  ///< the non-decision time varies from nondecision_s to this much more
  std::vector<double> drift;       ///< one for each difficulty
};

/// What a fit estimates besides boundary, non-decision time and drifts, and how. The report fits contaminants
/// only, because a session has too few trials for the others.
struct DiffusionOptions {
  bool contaminants = true;         ///< false: every trial was a decision
  bool start = false;               ///< false: the process starts half-way
  bool drift_varies = false;        ///< a standard deviation of the drift between trials
  bool nondecision_varies = false;  ///< a range of the non-decision time between trials
  enum class Method {
    posterior,   ///< medians and central intervals of the posterior distribution
    likelihood,  ///< the maximum of the likelihood, best of five starts, without priors; Wald intervals
  } method = Method::posterior;
  double confidence = 0.95;
};

struct DiffusionEstimates {
  Estimate boundary, nondecision_s;
  std::vector<Estimate> drift;  ///< one for each difficulty
  /// what the options ask for; else 0, 0.5, 0 and 0
  Estimate contaminants, start, drift_sd, nondecision_range_s;
  std::vector<DiffusionDraw> draws;  ///< draws of equal weight (Method::likelihood: normally distributed)
  /// number of independent draws that the least certain of the numbers above is worth, at most draws.size()
  double effective_draws = 0;
  double log_likelihood = 0;  ///< at the mode, without priors; densities per s
};

struct DiffusionFit {
  std::optional<DiffusionEstimates> estimates;  ///< empty if they cannot be determined
  std::vector<Statement> statements;            ///< the reason
};

/// Fits a diffusion between two boundaries to all trials of one condition: correct and wrong answers with
/// their times, answers that came too late or too early as what they are (censored), and a mixture with
/// trials that were no decision. Boundary and non-decision time are shared by all difficulties; each
/// difficulty has a drift of its own. Times are never trimmed: the mixture takes the place of an exclusion
/// rule, which would change the shape of the distribution that is fitted.
///
/// Half of the contaminants answer at random, half as the decision would have been (someone who pauses, or
/// looks away). Their times are uniform from 0 to twice the deadline; without a deadline, up to the longest
/// time of the condition. Priors: uniform in the logarithm of the boundary and in
/// the non-decision time above 0; normal with SD 1 per s (s = 0.1) for drifts; Beta(1, 19), mean 5 %, for the
/// proportion of contaminants; Beta(2, 2) for the start; half-normal with SD 0.2 per s (s = 0.1) for the
/// drift's standard deviation, and with SD 0.2 s for the range of the non-decision time.
///
/// The posterior distribution is sampled by importance sampling: 1000 draws from a multivariate t
/// distribution around its mode, and further rounds from distributions that fit the draws so far, until the
/// least certain quantile is worth 400 independent draws and each end of an interval has a standard error
/// below 5 % of the interval's width, but at most 16 rounds. `seed` makes the result reproducible.
DiffusionFit fit_diffusion(const std::vector<DiffusionTrial>& trials, std::size_t difficulties,
                           std::uint64_t seed, int stream, const DiffusionOptions& options = {});

/// The quantiles of response times that a check compares.
constexpr std::array<double, 5> kPredictedQuantiles{0.1, 0.3, 0.5, 0.7, 0.9};
constexpr int kCheckReplicates = 1000;

/// The right or the wrong answers to one difficulty, as observed and as the fitted model predicts them.
struct PredictedAnswers {
  int observed = 0;        ///< number of these answers
  double probability = 0;  ///< predicted proportion of the presented trials
  std::optional<double> observed_mean_s;
  double mean_s = 0;  ///< predicted mean time
  /// at kPredictedQuantiles, with 95 % intervals between order statistics; empty with fewer than 5 answers
  std::vector<Estimate> observed_quantiles;
  std::array<double, 5> quantile_s{};  ///< predicted, at kPredictedQuantiles
};

struct PredictedDifficulty {
  PredictedAnswers right, wrong;  ///< with the deadline that most trials of the difficulty have
};

/// Whether a fitted diffusion describes the answers of a condition.
struct DiffusionCheck {
  std::vector<PredictedDifficulty> difficulties;  ///< in the order of DiffusionEstimates::drift
  double statistic = 0;                           ///< how far the answers are from the prediction
  std::vector<double> replicates;                 ///< the same for kCheckReplicates simulated sets of answers
};

/// Compares the answers with what the fit predicts: chi squared over bins of time (right, wrong, too late,
/// too early; by difficulty), without its part along the directions in which the parameters can move the
/// prediction. So it does not matter that the parameters were estimated from the same answers (Dzhaparidze &
/// Nikulin 1974). The replicates are drawn from the predicted probabilities, because chi squared has its
/// limiting distribution only with many trials.
DiffusionCheck check_diffusion(const std::vector<DiffusionTrial>& trials, const DiffusionEstimates& fitted,
                               std::uint64_t seed, int stream);

/// The share of simulated sessions that are as far from the prediction as the observed one, or farther, over
/// all conditions together; empty without checks.
std::optional<double> share_as_bad(const std::vector<const DiffusionCheck*>& checks);

}  // namespace turnpoint::analysis

#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/diffusion.hpp"
#include "station/analysis/estimate.hpp"
#include "station/analysis/speed_accuracy.hpp"

namespace turnpoint::analysis {

/// Trials of equal difficulty under one instruction.
struct DifficultyCell {
  double difficulty = 0;
  int answered = 0, correct = 0;
  double proportion_correct = 0;
  Interval accuracy;                     ///< Wilson interval of `proportion_correct`
  std::optional<double> mean_correct_s;  ///< mean time of correct answers; empty if there were none
  std::optional<Estimate> drift;         ///< drift rate from the diffusion fit of all difficulties together
};

/// The results of one condition: an instruction, or whatever else TrialRecord::instruction contains. Accuracy
/// and times come from the answered experimental trials that the exclusion rule keeps. A score that cannot be
/// computed is empty.
struct InstructionResult {
  std::string instruction;
  int presented = 0, answered = 0, timeouts = 0, anticipations = 0, excluded = 0, correct = 0;
  std::optional<double> deadline_s;            ///< of the trials, if all have the same
  std::optional<Estimate> proportion_correct;  ///< with its Wilson interval
  /// sensitivity over all levels; trade() leaves it empty, because it depends on the task (detect())
  std::optional<Estimate> d_prime;
  std::optional<ResponseTimes> times, correct_times;
  std::vector<double> times_s;  ///< times of the included trials, in order of presentation
  std::vector<CafBin> caf;
  std::vector<DifficultyCell> cells;  ///< one cell per difficulty, ascending by DifficultyCell::difficulty
  std::optional<Estimate> median_s, lisas_s, inverse_efficiency_s;
  /// of the diffusion model (fit_diffusion()), from all answers and those that came too late; no time is
  /// excluded
  std::optional<Estimate> boundary, nondecision_s, contaminants;
  /// points a trial, and points a minute of trials with their pauses, from all trials that are not void
  std::optional<Estimate> points, points_per_minute;
  std::optional<double> effective_draws;  ///< how many independent draws the numbers of the model rest on
  std::optional<Estimate> drift;          ///< mean of the drifts over the condition's difficulties
  std::optional<DiffusionCheck> check;    ///< what the fit predicts, for each of `difficulties`
  std::vector<double> difficulties;       ///< ascending
  std::optional<Estimate> post_error_s;   ///< post_error_slowing()
  std::optional<Estimate> repetition;     ///< repetition()
  /// boundary of the diffusion in the second half of each block minus that in the first half (`late_half`);
  /// each half has a fit of its own
  std::optional<Estimate> late_boundary;
  std::vector<Statement> statements;
};

/// The names of measures, of which differences and studies are made. That of the conditional accuracy is
/// followed by the bin of time ("1 of 5").
inline constexpr const char *kCorrect = "proportion correct", *kMedianTime = "median response time",
                            *kSensitivity = "d'", *kBoundary = "boundary",
                            *kNondecision = "time outside the decision", *kDrift = "drift", *kLisas = "LISAS",
                            *kInverseEfficiency = "inverse efficiency", *kPoints = "points a trial",
                            *kPointsPerMinute = "points a minute",
                            *kBinMeasure = "proportion correct in time bin ",
                            *kRocArea = "area under the ROC";
/// True for measures that lie between 0 and 1.
bool is_proportion(const std::string& measure);

/// The difference between two conditions, second minus first.
struct Difference {
  std::string first, second;
  std::string measure;  ///< kCorrect, kMedianTime, ...
  /// the unit of the measure: "s", "proportion", or "s = 0.1" for the diffusion's boundary and drift (its
  /// scaling parameter)
  std::string unit;
  /// with a p value. Of a bootstrap or a posterior it is twice the smaller share of draws on one side of 0;
  /// with fewer than ten draws there, by the normal distribution
  std::optional<Estimate> estimate;
  std::optional<double> corrected_p =
      {};  ///< after Holm's correction (holm()); empty if it was not asked for
};

struct Trade {
  /// one for each condition, in the order of TradeOptions::order
  std::vector<InstructionResult> instructions;
  /// one for each pair of conditions; the earlier condition is `first`
  std::vector<Difference> differences;
  /// share of simulated sessions that the fitted diffusions describe as badly as this one (share_as_bad());
  /// below 0.05, a statement says that the model does not fit
  std::optional<double> model_p;
  std::vector<Statement> statements;
};

struct TradeOptions {
  /// order of conditions; conditions not listed follow in the order in which they first occur
  std::vector<std::string> order;
  TimeExclusion exclusion;
  int caf_bins = 5;
  int replicates = 1000;
  double confidence = 0.95;
  std::uint64_t seed = 1;
  bool halves = false;  ///< fits both halves of the blocks, for InstructionResult::late_boundary
};

/// Analyses speed and accuracy by condition. The diffusion model is fitted to all difficulties of a condition
/// together, with one boundary and one Ter (diffusion.hpp); intervals of its parameters and of their
/// differences come from its posterior distribution. The difference of drifts is the mean over the
/// difficulties that both conditions have. Differences of proportions have Newcombe's hybrid interval (1998),
/// those in bins of time as well: they compare the first, second, ... fifth of the answers of two conditions.
/// Other intervals are percentiles of a bootstrap that resamples answers within condition and difficulty, and
/// excludes times from each replicate as from the session. If more than 5 % of the replicates have no number,
/// both the number and its interval are empty. LISAS uses the standard deviations over all trials of the
/// session. The balanced integration score is not among the measures: it standardises over participants and
/// conditions, so only a study has it (report/study.hpp).
Trade trade(const std::vector<TrialRecord>& trials, const TradeOptions& options);

}  // namespace turnpoint::analysis

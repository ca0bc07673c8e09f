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
  std::optional<double> drift;           ///< drift rate from the diffusion fit of all difficulties together
};

/// The results of one condition: an instruction, or whatever else TrialRecord::instruction contains. Accuracy
/// and times come from the answered experimental trials that the exclusion rule keeps. A score that cannot be
/// computed is empty.
struct InstructionResult {
  std::string instruction;
  int presented = 0, answered = 0, timeouts = 0, anticipations = 0, excluded = 0, correct = 0;
  std::optional<Estimate> proportion_correct;  ///< with its Wilson interval
  std::optional<ResponseTimes> times, correct_times;
  std::vector<double> times_s;  ///< times of the included trials, in order of presentation
  std::vector<CafBin> caf;
  std::vector<DifficultyCell> cells;  ///< one cell per difficulty, ascending by DifficultyCell::difficulty
  std::optional<Estimate> median_s, boundary, nondecision_s, lisas_s, inverse_efficiency_s, balanced;
  std::vector<Statement> statements;
};

/// The difference between two conditions, second minus first.
struct Difference {
  std::string first, second;
  std::string measure;  ///< "proportion correct", "median response time", ...
  /// the unit of the measure: "s", "proportion", "s = 0.1" for EZ-diffusion (its scaling parameter), or "SD"
  /// for BIS (the standard deviation over cells)
  std::string unit;
  std::optional<Estimate> estimate;
};

struct Trade {
  /// one for each condition, in the order of TradeOptions::order
  std::vector<InstructionResult> instructions;
  /// one for each pair of conditions; the earlier condition is `first`
  std::vector<Difference> differences;
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
};

/// Analyses speed and accuracy by condition. The diffusion model is fitted to all difficulties of a condition
/// together, with one boundary and one Ter. Intervals are percentiles of a bootstrap that resamples trials
/// within condition and difficulty. Only the boundary's interval is different: it assumes that the logarithm
/// of the boundary is normal, with the standard deviation of shared_ez_diffusion(). If more than 5 % of the
/// replicates cannot be fitted, both the number and its interval are empty. LISAS uses the standard
/// deviations over all trials of the session, BIS those over the session's cells. A single condition has no
/// BIS, because the scores of its cells always average 0.
Trade trade(const std::vector<TrialRecord>& trials, const TradeOptions& options);

}  // namespace turnpoint::analysis

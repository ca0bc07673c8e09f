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
  Interval accuracy;                     ///< Wilson interval
  std::optional<double> mean_correct_s;  ///< empty if no answer was correct
  std::optional<double> drift;           ///< from the shared fit
};

/// The results of one condition, which is an instruction or whatever else TrialRecord::instruction contains.
/// Accuracy and times cover the answered experimental trials that the time rule keeps. Scores that cannot be
/// computed are empty.
struct InstructionResult {
  std::string instruction;
  int presented = 0, answered = 0, timeouts = 0, anticipations = 0, excluded = 0, correct = 0;
  std::optional<Estimate> proportion_correct;  ///< Wilson interval
  std::optional<ResponseTimes> times, correct_times;
  std::vector<double> times_s;  ///< times of the included trials, in order of presentation
  std::vector<CafBin> caf;
  std::vector<DifficultyCell> cells;  ///< in order of increasing difficulty
  std::optional<Estimate> median_s, boundary, nondecision_s, lisas_s, inverse_efficiency_s, balanced;
  std::vector<Statement> statements;
};

/// The difference between two conditions, second minus first.
struct Difference {
  std::string first, second;
  std::string measure;  ///< "proportion correct", "median response time", ...
  std::string unit;     ///< "s", "proportion", "s = 0.1" (EZ's scale), "SD" (of BIS over cells)
  std::optional<Estimate> estimate;
};

struct Trade {
  std::vector<InstructionResult> instructions;  ///< in the order of the options
  /// for all pairs, with the first before the second in that order
  std::vector<Difference> differences;
  std::vector<Statement> statements;
};

struct TradeOptions {
  std::vector<std::string> order;  ///< order of conditions; others follow in the order of first occurrence
  TimeExclusion exclusion;
  int caf_bins = 5;
  int replicates = 1000;
  double confidence = 0.95;
  std::uint64_t seed = 1;
};

/// Speed and accuracy by instruction. The diffusion model is fitted within equal difficulty, with shared
/// boundary and Ter. Intervals are percentiles of a bootstrap that resamples trials within instruction and
/// difficulty. Only the boundary's interval is different: it is normal in the logarithm, with the standard
/// deviation of shared_ez_diffusion(). If more than 5 % of the replicates cannot be fitted, there is neither
/// an interval nor a number. LISAS uses the standard deviations of all trials of the session, BIS those over
/// its cells. A single condition has no BIS, because the scores of its cells always average 0.
Trade trade(const std::vector<TrialRecord>& trials, const TradeOptions& options);

}  // namespace turnpoint::analysis

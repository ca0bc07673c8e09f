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
  Interval accuracy;                     ///< Wilson
  std::optional<double> mean_correct_s;  ///< none where nothing was right
  std::optional<double> drift;           ///< of the shared fit
};

/// What one condition did: an instruction, or what else TrialRecord::instruction says. Accuracy and times are
/// of answered experimental trials that the time rule keeps; scores whose value cannot be had are none.
struct InstructionResult {
  std::string instruction;
  int presented = 0, answered = 0, timeouts = 0, anticipations = 0, excluded = 0, correct = 0;
  std::optional<Estimate> proportion_correct;  ///< Wilson
  std::optional<ResponseTimes> times, correct_times;
  std::vector<double> times_s;  ///< those summarised, in order of presentation
  std::vector<CafBin> caf;
  std::vector<DifficultyCell> cells;  ///< by rising difficulty
  std::optional<Estimate> median_s, boundary, nondecision_s, lisas_s, inverse_efficiency_s, balanced;
  std::vector<Statement> statements;
};

/// Of two conditions, second minus first.
struct Difference {
  std::string first, second;
  std::string measure;  ///< "proportion correct", "median response time", ...
  std::string unit;     ///< "s", "proportion", "s = 0.1" (EZ's scale), "SD" (of BIS over cells)
  std::optional<Estimate> estimate;
};

struct Trade {
  std::vector<InstructionResult> instructions;  ///< in the order of the options
  std::vector<Difference> differences;          ///< of all pairs, the first before the second in that order
  std::vector<Statement> statements;
};

struct TradeOptions {
  std::vector<std::string> order;  ///< of conditions; others follow in the order first met
  TimeExclusion exclusion;
  int caf_bins = 5;
  int replicates = 1000;
  double confidence = 0.95;
  std::uint64_t seed = 1;
};

/// Speed and accuracy by instruction, the diffusion fitted within equal difficulty with shared boundary and
/// Ter. Intervals are percentiles of a bootstrap that draws trials anew within instruction and difficulty,
/// but the boundary's, which is normal in its logarithm with the standard deviation of shared_ez_diffusion();
/// where more than 5 % of the replicates cannot be fitted there is no interval, and then no number. The score
/// LISAS uses the standard deviations of all trials of the session, BIS those over its cells; a single
/// condition has no BIS, since the scores of its cells average 0 whatever was answered.
Trade trade(const std::vector<TrialRecord>& trials, const TradeOptions& options);

}  // namespace turnpoint::analysis

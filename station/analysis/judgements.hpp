#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// The numbers that a participant gave at one level.
struct JudgedLevel {
  double level = 0;
  std::vector<double> values;  ///< in order of presentation
  /// mean or geometric mean; 95 % interval by Student's t (of the logarithms), empty with fewer than 3 values
  std::optional<Estimate> mean;
  double median = 0;
};

/// Ratings or magnitudes of one condition, by level.
struct Judgements {
  std::string condition;
  std::vector<JudgedLevel> levels;  ///< in ascending order
  /// For magnitudes, the exponent of Stevens' law: the slope of log magnitude over log level, by least
  /// squares over all trials; 95 % interval by Student's t.
  std::optional<Estimate> exponent;
  std::vector<Statement> statements;
};

enum class Judged {
  ratings,
  magnitudes,     ///< levels have a physical unit
  magnitudes_dB,  ///< levels are 20 log10 of a physical quantity
};

/// Analyses the ratings or magnitudes (TrialRecord::setting) of answered experimental trials, one entry for
/// each condition. Conditions in `order` come first.
std::vector<Judgements> judgements(const std::vector<TrialRecord>& trials,
                                   const std::vector<std::string>& order, Judged judged);

}  // namespace turnpoint::analysis

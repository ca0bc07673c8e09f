#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// A participant's settings of a slider. Their mean is the point of subjective equality, and their scatter is
/// a measure of the just noticeable difference (method of adjustment; Gescheider, Psychophysics: The
/// Fundamentals, ch. 3).
struct Settings {
  std::string procedure;
  std::string condition;               ///< TrialRecord::instruction; "" if the design has none
  std::vector<double> starts, values;  ///< in order of presentation, in the unit of the level
  std::optional<Estimate> mean;        ///< 95 % interval by Student's t; empty with fewer than 3 settings
  std::optional<Estimate> sd;          ///< 95 % interval by chi squared; empty with fewer than 3 settings
  /// how much a setting depends on its start: 0 not at all, 1 the slider was not moved
  std::optional<Estimate> start_slope;
  std::vector<Statement> statements;
};

/// The settings of answered experimental trials, one entry for each procedure and condition. The given
/// conditions come first, in this order; other conditions, and the procedures, follow in the order of first
/// occurrence.
std::vector<Settings> settings(const std::vector<TrialRecord>& trials,
                               const std::vector<std::string>& order = {});

}  // namespace turnpoint::analysis

#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// What a participant set by a slider: their mean is the point of subjective equality, their scatter its
/// just noticeable share (method of adjustment; Gescheider, Psychophysics: The Fundamentals, ch. 3).
struct Settings {
  std::string procedure;
  std::string condition;                ///< TrialRecord::instruction; "" where the design has none
  std::vector<double> starts, values;   ///< in order of presentation, in the unit of the level
  std::optional<Estimate> mean;         ///< 95 % by Student's t; none with fewer than 3 settings
  std::optional<Estimate> sd;           ///< 95 % by chi squared; none with fewer than 3 settings
  std::optional<Estimate> start_slope;  ///< how far a setting follows its start: 0 not at all, 1 unmoved
  std::vector<Statement> statements;
};

/// Of answered experimental trials with a setting, one entry for each procedure and condition: conditions in
/// this order, then others and procedures in the order first met.
std::vector<Settings> settings(const std::vector<TrialRecord>& trials,
                               const std::vector<std::string>& order = {});

}  // namespace turnpoint::analysis

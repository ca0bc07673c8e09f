#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// The settings from trials in which the slider started on the same side. Mean and standard deviation have
/// the same kinds of interval as in Settings.
struct SideSettings {
  int settings = 0;
  std::optional<Estimate> mean, sd;
};

/// A participant's settings of a slider. Their mean is the point of subjective equality, and their scatter is
/// a measure of the just noticeable difference (method of adjustment; Gescheider, Psychophysics: The
/// Fundamentals, ch. 3).
struct Settings {
  std::string procedure;
  std::string condition;  ///< TrialRecord::instruction; "" if the design has none
  /// starting positions and settings of the slider, in order of presentation, in the unit of the level
  std::vector<double> starts, values;
  std::optional<Estimate> mean;  ///< 95 % interval by Student's t; empty with fewer than 3 settings
  std::optional<Estimate> sd;    ///< 95 % interval by chi squared; empty with fewer than 3 settings
  /// slope of the settings over the slider's starting positions: 0 if the start has no influence, 1 if the
  /// slider was not moved
  std::optional<Estimate> start_slope;
  /// mean and scatter of the settings, by the side from which the slider started; both empty if the protocol
  /// has no sides
  SideSettings from_below, from_above;
  /// mean from below minus mean from above, with a 95 % interval by Welch's t
  std::optional<Estimate> side_difference;
  std::vector<Statement> statements;
};

/// Returns the settings of answered experimental trials, one entry for each procedure and condition.
/// Conditions in `order` come first. Other conditions, and the procedures, follow in the order in which they
/// first occur.
std::vector<Settings> settings(const std::vector<TrialRecord>& trials,
                               const std::vector<std::string>& order = {});

}  // namespace turnpoint::analysis

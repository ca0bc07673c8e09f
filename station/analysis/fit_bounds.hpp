#pragma once
#include "station/analysis/likelihood.hpp"

namespace turnpoint::analysis {

/// Code shared by a fit and its bootstrap: counts on the function's axis, the optimiser's bounds (threshold
/// within one range of the levels around them, rate from nearly flat to a step), and the conversion back to
/// parameters. Levels are ascending and unique, and those without trials are removed. Throws
/// std::invalid_argument for counts or options that make no sense.
std::vector<LevelCount> checked(const std::vector<LevelCount>& data, const FitOptions& options);
/// The reason why checked counts cannot be fitted: no trials, too few, or reversed. Independent of how the
/// levels were chosen.
std::optional<Statement> unusable(const std::vector<LevelCount>& data, const FitOptions& options);
AxisCounts axis_counts(const std::vector<LevelCount>& data, Function function, Scale scale);
ThetaBounds theta_bounds(const AxisCounts& counts, const FitOptions& options);
Psychometric from_theta(const Theta& theta, const FitOptions& options);
/// Adds a statement for each interval that touches a bound.
void say_what_touches(PsychometricIntervals& intervals);

}  // namespace turnpoint::analysis

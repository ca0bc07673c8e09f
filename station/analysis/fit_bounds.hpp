#pragma once
#include "station/analysis/likelihood.hpp"

namespace turnpoint::analysis {

/// What a fit and its bootstrap share: counts on the function's axis, the box of the optimiser (threshold one
/// range of the levels beyond them, rate from nearly flat to a step), and the way back to parameters.
/// Levels ascending, one entry each, those without trials removed. Throws std::invalid_argument for counts or
/// options that make no sense.
std::vector<LevelCount> checked(const std::vector<LevelCount>& data, const FitOptions& options);
/// Why nothing can be learnt from checked counts, however they came about: no trials, too few, reversed.
std::optional<Statement> unusable(const std::vector<LevelCount>& data, const FitOptions& options);
AxisCounts axis_counts(const std::vector<LevelCount>& data, Function function, Scale scale);
ThetaBounds theta_bounds(const AxisCounts& counts, const FitOptions& options);
Psychometric from_theta(const Theta& theta, const FitOptions& options);
/// Adds a statement for each interval that touches a bound.
void say_what_touches(PsychometricIntervals& intervals);

}  // namespace turnpoint::analysis

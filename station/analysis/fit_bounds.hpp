#pragma once
#include "station/analysis/likelihood.hpp"

namespace turnpoint::analysis {

/// Helpers that the fits and their intervals share. checked() sorts the counts by level, merges equal levels
/// and removes levels without trials. It throws std::invalid_argument for impossible counts or options.
std::vector<LevelCount> checked(const std::vector<LevelCount>& data, const FitOptions& options);
/// Returns the reason why checked counts cannot be fitted: no trials, too few, or an answer that becomes
/// rarer as the level rises. The reason does not depend on how the levels were chosen.
std::optional<Statement> unusable(const std::vector<LevelCount>& data, const FitOptions& options);
/// Each answer counts `weight` times.
AxisCounts axis_counts(const std::vector<LevelCount>& data, Function function, Scale scale,
                       double weight = 1);
/// Returns PsychometricFit::weight of checked counts for answers with the probability `fitted`.
double weight_of(const std::vector<LevelCount>& data, const FitOptions& options, const Psychometric& fitted);
ThetaBounds theta_bounds(const AxisCounts& counts, const FitOptions& options);
Psychometric from_theta(const Theta& theta, const FitOptions& options);
/// Adds a statement for each interval that ends at a bound of its parameter.
void say_what_touches(PsychometricIntervals& intervals);

}  // namespace turnpoint::analysis

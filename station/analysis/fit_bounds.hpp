#pragma once
#include "station/analysis/likelihood.hpp"

namespace turnpoint::analysis {

/// What a fit and its bootstrap share: counts on the function's axis, the box of the optimiser (threshold one
/// range of the levels beyond them, rate from nearly flat to a step), and the way back to parameters.
AxisCounts axis_counts(const std::vector<LevelCount>& data, Function function, Scale scale);
ThetaBounds theta_bounds(const AxisCounts& counts, const FitOptions& options);
Psychometric from_theta(const Theta& theta, const FitOptions& options);

}  // namespace turnpoint::analysis

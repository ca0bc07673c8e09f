#pragma once
// What measured boundaries say about a surface.
#include <span>
#include <vector>

#include "physics/boundary_map.hpp"

namespace turnpoint::physics {

// An edge that was seen at this frequency. `sd_m` is the precision of the measurement, above 0.
struct MeasuredBoundary {
  double frequency_Hz = 0;
  double boundary_m = 0;
  double sd_m = 0;
};

struct FittedParameter {
  Parameter parameter;
  double change = 0;    // the estimate minus the value in the surface, SI units
  double sd = 0;        // standard deviation of the estimate
  double prior_sd = 0;  // the surface's own
};

// One entry of each of the last three for each measured boundary.
struct BoundaryFit {
  std::vector<FittedParameter> parameters;
  std::vector<Correlation> correlations;
  std::vector<double> residuals_m;  // measured minus fitted
  // How far each boundary is from where the others put it, in standard deviations.
  std::vector<double> deviations;
  std::vector<bool> outliers;
};

// The most probable surface, if its parameters scatter about what it states with its standard deviations
// (maximum a posteriori, by Gauss-Newton steps; the posterior is taken as normal). A parameter without a
// standard deviation stays as it is. Temperature is allowed to differ on the day of the measurement, but is
// not part of the result. Boundaries may be as few as one. An outlier is more than 3 standard deviations from
// where the others put it; with few boundaries two or three may be named that contradict each other.
// options.edge says which edge was measured. Throws std::domain_error if the surface has no such edge at a
// frequency, std::invalid_argument for values out of range and if no parameter has a standard deviation.
BoundaryFit fit_boundaries(const Surface& surface, const MapOptions& options,
                           std::span<const MeasuredBoundary> measured);

// The surface with the fitted parameters, their standard deviations and correlations.
Surface with_fit(Surface surface, const std::vector<FittedParameter>& parameters,
                 const std::vector<Correlation>& correlations);

}  // namespace turnpoint::physics

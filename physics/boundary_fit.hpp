#pragma once
// Estimates the parameters of a surface from measured boundaries.
#include <span>
#include <vector>

#include "physics/boundary_map.hpp"

namespace turnpoint::physics {

// The measured position of an edge at one frequency. `sd_m` is the precision of the measurement, 1 nm to 1 m.
struct MeasuredBoundary {
  double frequency_Hz = 0;
  double boundary_m = 0;
  double sd_m = 0;
};

struct FittedParameter {
  Parameter parameter;
  double change = 0;    // the estimate minus the value in the surface, SI units
  double sd = 0;        // standard deviation of the estimate
  double prior_sd = 0;  // standard deviation before the fit, from the surface
};

// The result of a fit. `residuals_m`, `deviations` and `outliers` have one entry for each measured boundary.
struct BoundaryFit {
  std::vector<FittedParameter> parameters;
  std::vector<Correlation> correlations;
  std::vector<double> residuals_m;  // measured minus fitted position of each boundary
  // Distance of each boundary from the position that the other boundaries predict, in standard deviations.
  std::vector<double> deviations;
  std::vector<bool> outliers;
  // True if the outliers are left out of the fit. That is so if the other boundaries agree with one another,
  // because only then is it clear which boundaries are wrong. If boundaries contradict each other equally,
  // all of them are used.
  bool left_out = false;
};

// Fits the parameters of the surface to one or more measured boundaries. The prior of each parameter is a
// normal distribution with the surface's value and standard deviation. The estimate is the maximum a
// posteriori, found by Gauss-Newton steps; the posterior is approximated as normal. A parameter without a
// standard deviation keeps its value. The temperature of the measurement is fitted too, but is not part of
// the result. A boundary is an outlier if it lies more than 3 standard deviations from where the others
// predict it. With few boundaries, two or three that contradict each other may all be marked. options.edge
// says which edge was measured. Throws Refused if the surface has no such edge at a measured
// frequency, if a value is out of range, or if no parameter has a standard deviation.
BoundaryFit fit_boundaries(const Surface& surface, const MapOptions& options,
                           std::span<const MeasuredBoundary> measured);

// Returns the surface with the fitted parameters, their standard deviations and their correlations.
Surface with_fit(Surface surface, const std::vector<FittedParameter>& parameters,
                 const std::vector<Correlation>& correlations);

}  // namespace turnpoint::physics

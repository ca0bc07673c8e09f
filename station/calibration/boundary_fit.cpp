#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "station/calibration/fits.hpp"
#include "station/calibration/least_squares.hpp"
#include "station/terms/usage_error.hpp"

namespace turnpoint::calibration {
namespace {

struct Line {
  LeastSquares solution;
  std::vector<double> residuals;
  double rms = 0;
};

// Fits position = a - c frequency^-exponent to the points by weighted least squares; a and c are unknown.
Line fit_line(const std::vector<BoundaryPoint>& points, const std::vector<double>& weights, double exponent) {
  std::vector<std::vector<double>> rows;
  std::vector<double> values;
  for (const BoundaryPoint& point : points) {
    rows.push_back({1, -std::pow(point.frequency_Hz, -exponent)});
    values.push_back(point.boundary_m);
  }
  Line line;
  line.solution = least_squares(rows, values, weights);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double at = line.solution.value[0] + line.solution.value[1] * rows[k][1];
    line.residuals.push_back(points[k].boundary_m - at);
    line.rms += line.residuals.back() * line.residuals.back() / static_cast<double>(points.size());
  }
  line.rms = std::sqrt(line.rms);
  return line;
}

// Fits a parabola in 1/frequency to the positions. Returns the absolute value of the quadratic coefficient
// divided by its standard error.
std::optional<double> curvature(const std::vector<BoundaryPoint>& points,
                                const std::vector<double>& weights) {
  if (points.size() < 4) return std::nullopt;
  double mean = 0;
  for (const BoundaryPoint& point : points)
    mean += 1 / point.frequency_Hz / static_cast<double>(points.size());
  std::vector<std::vector<double>> rows;
  std::vector<double> values;
  for (const BoundaryPoint& point : points) {
    const double u = 1 / point.frequency_Hz / mean - 1;  // scaled so that the equations are well conditioned
    rows.push_back({1, u, u * u});
    values.push_back(point.boundary_m);
  }
  const LeastSquares fit = least_squares(rows, values, weights);
  if (!(fit.sd[2] > 0)) return std::nullopt;
  return std::abs(fit.value[2]) / fit.sd[2];
}

void check(const std::vector<BoundaryPoint>& points, bool law_known) {
  const std::size_t needed = law_known ? 2 : 3;
  if (points.size() < needed)
    throw terms::UsageError(fmt::format("there are {} measured boundaries, but {} or more are needed{}",
                                        points.size(), needed,
                                        law_known ? "" : " to tell a membrane from a plate"));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].frequency_Hz > 0) || !std::isfinite(points[i].boundary_m) || !(points[i].sd_m >= 0))
      throw terms::UsageError(
          fmt::format("boundary at {} m for {} Hz; the position must be finite, the frequency above 0 and "
                      "the SD not negative",
                      points[i].boundary_m, points[i].frequency_Hz));
    for (std::size_t j = 0; j < i; ++j)
      if (points[i].frequency_Hz == points[j].frequency_Hz && points.size() < 3)
        throw terms::UsageError(
            fmt::format("two boundaries for {} Hz; the frequencies must differ", points[i].frequency_Hz));
  }
}

}  // namespace

BoundaryFit fit_boundaries(const std::vector<BoundaryPoint>& points, std::optional<BoundaryFit::Law> law) {
  check(points, law.has_value());
  const bool weighted = std::all_of(points.begin(), points.end(), [](const auto& p) { return p.sd_m > 0; });
  std::vector<double> weights;
  for (const BoundaryPoint& point : points) weights.push_back(weighted ? 1 / (point.sd_m * point.sd_m) : 1);
  const Line membrane = fit_line(points, weights, 1), plate = fit_line(points, weights, 0.5);
  BoundaryFit fit;
  fit.membrane_residual_m = membrane.rms;
  fit.plate_residual_m = plate.rms;
  fit.law = law.value_or(plate.rms < membrane.rms ? BoundaryFit::Law::plate : BoundaryFit::Law::membrane);
  const Line& line = fit.law == BoundaryFit::Law::plate ? plate : membrane;
  fit.exponent = fit.law == BoundaryFit::Law::plate ? 0.5 : 1;
  fit.apex_m = line.solution.value[0];
  fit.constant = line.solution.value[1];
  fit.apex_sd_m = weighted ? line.solution.known_sd[0] : line.solution.sd[0];
  fit.constant_sd = weighted ? line.solution.known_sd[1] : line.solution.sd[1];
  fit.residuals_m = line.residuals;
  fit.residual_m = points.size() > 2 ? line.rms : 0;
  fit.curvature_z = curvature(points, weights);
  return fit;
}

double boundary_at(const BoundaryFit& fit, double frequency_Hz) {
  return fit.apex_m - fit.constant * std::pow(frequency_Hz, -fit.exponent);
}

}  // namespace turnpoint::calibration

#include <fmt/format.h>

#include <stdexcept>

#include "physics/boundary_budget.hpp"
#include "physics/boundary_fit.hpp"
#include "station/calibration/fits.hpp"
#include "station/rig/physical.hpp"
#include "station/terms/usage_error.hpp"
#include "station/text/number.hpp"
#include "station/texts/refusal.hpp"

namespace turnpoint::calibration {
namespace {

rig::SurfaceFit surface_fit(const physics::BoundaryFit& fit) {
  rig::SurfaceFit surface;
  for (const auto& p : fit.parameters) {
    std::vector<double> correlations;
    for (const auto& c : fit.correlations)
      if (c.second == p.parameter) correlations.push_back(c.coefficient);
    surface.parameters.push_back(
        {std::string(physics::name(p.parameter)), p.change, p.sd, p.prior_sd, std::move(correlations)});
  }
  return surface;
}

/// Throws if boundaries contradict each other or the rig, and the fit could not leave out the wrong ones.
void require_agreement(const physics::BoundaryFit& fit, const std::vector<BoundaryPoint>& points) {
  if (fit.left_out) return;
  std::string named;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (fit.outliers[i])
      named += fmt::format("{}{} mm at {} Hz", named.empty() ? "" : ", ",
                           text::number(1e3 * points[i].boundary_m), text::number(points[i].frequency_Hz));
  if (!named.empty()) throw texts::Refusal(texts::phrase("series.contradict", {texts::plain(named)}));
}

}  // namespace

BoundaryFit fit_boundaries(const rig::Rig& rig, const std::string& edge, std::vector<BoundaryPoint> points) {
  try {
    physics::MapOptions options;
    options.edge = physics::parse_edge(edge);
    if (options.edge.kind == physics::Edge::Kind::friction)
      throw texts::Refusal(texts::phrase("fitted.edge", {texts::plain(edge)}));
    std::vector<physics::MeasuredBoundary> measured;
    for (const auto& point : points) measured.push_back({point.frequency_Hz, point.boundary_m, point.sd_m});
    const auto fit = physics::fit_boundaries(rig::surface_of(rig), options, measured);
    require_agreement(fit, points);
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].residual_m = fit.residuals_m[i];
      points[i].deviation = fit.deviations[i];
      points[i].outlier = fit.outliers[i];
      points[i].left_out = fit.left_out && fit.outliers[i];
    }
    return {physics::format(options.edge), std::move(points), surface_fit(fit)};
  } catch (const physics::Refused& refused) {
    throw texts::Refusal(rig::phrase_of(refused));
  } catch (const std::invalid_argument& error) {
    throw terms::UsageError(error.what());
  }
}

}  // namespace turnpoint::calibration

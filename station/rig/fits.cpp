#include "station/rig/fits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/boundary_budget.hpp"
#include "physics/boundary_fit.hpp"
#include "station/core/least_squares.hpp"
#include "station/core/median.hpp"
#include "station/core/number.hpp"
#include "station/core/texts.hpp"
#include "station/core/usage_error.hpp"
#include "station/rig/physical.hpp"

namespace turnpoint::rig {
namespace {

SurfaceFit surface_fit(const physics::BoundaryFit& fit) {
  SurfaceFit surface;
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
  constexpr std::ptrdiff_t most = 10;
  const auto all = std::count(fit.outliers.begin(), fit.outliers.end(), true);
  std::string named;
  std::ptrdiff_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (fit.outliers[i] && ++count <= most)
      named += fmt::format("{}{} mm at {} Hz", named.empty() ? "" : ", ",
                           core::number(1e3 * points[i].boundary_m), core::number(points[i].frequency_Hz));
  if (all > most) named += fmt::format(", ... ({} in all)", all);
  if (!named.empty()) throw core::Refusal(core::phrase("series.contradict", {core::plain(named)}));
}

}  // namespace

BoundaryFit fit_boundaries(const Rig& rig, const std::string& edge, std::vector<BoundaryPoint> points) {
  if (points.size() > kMostBoundaries)
    throw core::Refusal(
        core::phrase("series.too_many", {core::plain(points.size()), core::plain(kMostBoundaries)}));
  try {
    physics::MapOptions options;
    options.edge = physics::parse_edge(edge);
    if (options.edge.kind == physics::Edge::Kind::friction)
      throw core::Refusal(core::phrase("fitted.edge", {core::plain(edge)}));
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
    throw core::Refusal(rig::phrase_of(refused));
  } catch (const std::invalid_argument& error) {
    throw core::UsageError(error.what());
  }
}

namespace {

using core::plain;

// A peak counts as a resonance only if the phase turns by at least this angle. Between the half-power points
// of a resonance, the phase turns by 90 degrees; at a hump of the transducer's response it turns only a
// little.
constexpr double least_turn_rad = std::numbers::pi / 4;

void check(const std::vector<ResponsePoint>& sweep, int window) {
  if (sweep.size() < 5 || window < 3)
    throw core::Refusal(core::phrase("series.short_sweep", {plain(sweep.size()), plain(window)}));
  for (std::size_t k = 0; k < sweep.size(); ++k) {
    const bool rising = k == 0 || sweep[k].frequency_Hz > sweep[k - 1].frequency_Hz;
    if (!rising || !(sweep[k].frequency_Hz > 0) || !(sweep[k].m_per_full_scale > 0) ||
        !std::isfinite(sweep[k].phase_rad))
      throw core::Refusal(
          core::phrase("series.sweep_point", {plain(fmt::format("{}", sweep[k].frequency_Hz))}));
  }
}

std::vector<double> unwrapped(const std::vector<ResponsePoint>& sweep) {
  std::vector<double> phase;
  for (const ResponsePoint& point : sweep) {
    const double last = phase.empty() ? point.phase_rad : phase.back();
    const double turns = std::round((last - point.phase_rad) / (2 * std::numbers::pi));
    phase.push_back(point.phase_rad + turns * 2 * std::numbers::pi);
  }
  return phase;
}

// Local quadratic fit around point k with tricube weights over the nearest `window` points (Cleveland 1979).
double smoothed(const std::vector<ResponsePoint>& sweep, const std::vector<double>& values, std::size_t k,
                std::size_t window) {
  const std::size_t first = std::min(k > window / 2 ? k - window / 2 : 0, sweep.size() - window);
  const double centre = sweep[k].frequency_Hz;
  const double reach =
      1.0001 * std::max(centre - sweep[first].frequency_Hz, sweep[first + window - 1].frequency_Hz - centre);
  std::vector<std::vector<double>> rows;
  std::vector<double> some, weights;
  for (std::size_t i = first; i < first + window; ++i) {
    const double u = (sweep[i].frequency_Hz - centre) / reach;
    rows.push_back({1, u, u * u});
    some.push_back(values[i]);
    weights.push_back(std::pow(1 - std::pow(std::abs(u), 3), 3));
  }
  return core::least_squares(rows, some, weights).value[0];
}

}  // namespace

ResponseFit fit_response(const std::vector<ResponsePoint>& sweep, int window) {
  check(sweep, window);
  const std::size_t width = std::min(sweep.size(), static_cast<std::size_t>(std::max(window, 5)));
  std::vector<double> logs;
  for (const ResponsePoint& point : sweep) logs.push_back(std::log(point.m_per_full_scale));
  const std::vector<double> phases = unwrapped(sweep);
  ResponseFit fit;
  const auto count = static_cast<double>(sweep.size());
  double best = 0;
  for (std::size_t k = 0; k < sweep.size(); ++k) {
    const double log = smoothed(sweep, logs, k, width), phase = smoothed(sweep, phases, k, width);
    fit.points.push_back({sweep[k].frequency_Hz, std::exp(log), phase});
    fit.residual_dB += std::pow((logs[k] - log) * 20 / std::numbers::ln10, 2) / count;
    fit.residual_rad += std::pow(phases[k] - phase, 2) / count;
    best = std::max(best, std::exp(log));
  }
  fit.residual_dB = std::sqrt(fit.residual_dB);
  fit.residual_rad = std::sqrt(fit.residual_rad);
  const double least = best * std::pow(10, -equalisation_cap_dB / 20);
  // Find the band around the best frequency in which no point needs more than equalisation_cap_dB.
  std::size_t peak = 0;
  for (std::size_t k = 0; k < fit.points.size(); ++k)
    if (fit.points[k].m_per_full_scale == best) peak = k;
  std::size_t low = peak, high = peak;
  while (low > 0 && fit.points[low - 1].m_per_full_scale >= least) --low;
  while (high + 1 < fit.points.size() && fit.points[high + 1].m_per_full_scale >= least) ++high;
  fit.low_Hz = fit.points[low].frequency_Hz;
  fit.high_Hz = fit.points[high].frequency_Hz;
  return fit;
}

std::vector<Resonance> find_resonances(const std::vector<ResponsePoint>& sweep) {
  check(sweep, 3);
  const std::vector<double> phases = unwrapped(sweep);
  std::vector<Resonance> found;
  for (std::size_t k = 1; k + 1 < sweep.size(); ++k) {
    const double peak = sweep[k].m_per_full_scale;
    if (sweep[k - 1].m_per_full_scale >= peak || sweep[k + 1].m_per_full_scale > peak) continue;
    std::size_t low = k, high = k;
    while (low > 0 && sweep[low - 1].m_per_full_scale >= peak / std::numbers::sqrt2) --low;
    while (high + 1 < sweep.size() && sweep[high + 1].m_per_full_scale >= peak / std::numbers::sqrt2) ++high;
    if (high - low + 1 < 5) continue;
    if (std::abs(phases[high] - phases[low]) < least_turn_rad) continue;
    // With u = f / f_k - 1 and r = (amplitude at the peak k) / (amplitude at f), fit the parabola r^2 = a + b
    // u + c u^2. Its minimum is at u = -b/2c, and its squared half width is a/c - (b/2c)^2.
    std::vector<std::vector<double>> rows;
    std::vector<double> values;
    for (std::size_t i = low; i <= high; ++i) {
      const double u = sweep[i].frequency_Hz / sweep[k].frequency_Hz - 1,
                   r = peak / sweep[i].m_per_full_scale;
      rows.push_back({1, u, u * u});
      values.push_back(r * r);
    }
    const auto c = core::least_squares(rows, values, std::vector<double>(rows.size(), 1)).value;
    const double offset = -c[1] / (2 * c[2]), square = c[0] / c[2] - offset * offset;
    if (!(c[2] > 0 && square > 0)) continue;
    found.push_back({sweep[k].frequency_Hz * (1 + offset), (1 + offset) / (2 * std::sqrt(square))});
  }
  return found;
}

std::optional<double> quality_of(const std::vector<Resonance>& resonances) {
  if (resonances.empty()) return std::nullopt;
  std::vector<double> values;
  for (const Resonance& resonance : resonances) values.push_back(resonance.quality_factor);
  return core::median(values);
}

namespace {

/// Measured friction at one displacement, or at neighbouring ones that are pooled, with its weight.
struct Pool {
  double displacement_m, friction, weight;
  std::size_t points;  ///< number of measured points

  void add(const Pool& other) {
    const double both = weight + other.weight;
    displacement_m = (weight * displacement_m + other.weight * other.displacement_m) / both;
    friction = (weight * friction + other.weight * other.friction) / both;
    weight = both, points += other.points;
  }
};

/// Pools neighbours until friction falls from pool to pool. `measured` is in ascending order of displacement.
std::vector<Pool> falling_pools(const std::vector<FrictionPoint>& measured) {
  constexpr double equal = 1e-6, step_m = 2 * rig::kLeastStep_m;
  std::vector<Pool> pools;
  for (const auto& point : measured) {
    const Pool next{point.displacement_m, point.relative_friction, 1, 1};
    // Friction is relative to friction without vibration, so that it is 1 at displacement 0.
    if (point.displacement_m < step_m)
      pools.empty() ? pools.push_back({0, 1, 1, 1}) : pools.back().add({0, 1, 1, 1});
    else if (!pools.empty() && point.displacement_m - pools.back().displacement_m < step_m)
      pools.back().add(next);
    else
      pools.push_back(next);
  }
  std::vector<Pool> falling;
  for (const auto& pool : pools) {
    falling.push_back(pool);
    while (falling.size() > 1 && falling.back().friction > falling[falling.size() - 2].friction - equal) {
      const auto last = falling.back();
      falling.pop_back();
      falling.back().add(last);
    }
    // a rise above 1 at the beginning
    if (falling.size() == 1 && falling.front().friction > 1 - equal) falling.front().friction = 1;
  }
  return falling;
}

}  // namespace

FrictionFit fit_friction(std::vector<FrictionPoint> measured) {
  std::stable_sort(measured.begin(), measured.end(), [](const FrictionPoint& a, const FrictionPoint& b) {
    return a.displacement_m < b.displacement_m;
  });
  for (const FrictionPoint& point : measured)
    if (!(point.displacement_m >= 0 && point.displacement_m <= 1 &&
          point.relative_friction >= rig::kLeastFriction && point.relative_friction <= 1.5))
      throw core::Refusal(
          core::phrase("series.friction_point", {plain(fmt::format("{}", point.relative_friction)),
                                                 plain(fmt::format("{}", point.displacement_m))}));
  FrictionFit fit{{{0, 1}}, 0};
  std::string contradicting;
  std::size_t k = 0;
  for (const auto& pool : falling_pools(measured)) {
    if (pool.friction < 1)
      fit.points.push_back({pool.displacement_m, std::max(pool.friction, rig::kLeastFriction)});
    for (std::size_t i = 0; i < pool.points; ++i, ++k) {
      const double miss = measured[k].relative_friction - pool.friction;
      fit.residual += miss * miss / static_cast<double>(measured.size());
      if (std::abs(miss) > largest_friction_miss)
        contradicting += fmt::format("{}{} at {} um", contradicting.empty() ? "" : ", ",
                                     core::number(measured[k].relative_friction),
                                     core::number(1e6 * measured[k].displacement_m));
    }
  }
  if (!contradicting.empty()) throw core::Refusal(core::phrase("series.contradict", {plain(contradicting)}));
  fit.residual = std::sqrt(fit.residual);
  if (measured.size() < 2 || fit.points.size() < 2)
    throw core::Refusal(core::phrase("series.few_displacements"));
  return fit;
}

}  // namespace turnpoint::rig

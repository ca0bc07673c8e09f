#include "physics/boundary_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "physics/boundary_budget.hpp"
#include "physics/dispersion.hpp"
#include "physics/edge_feature.hpp"
#include "physics/edge_table.hpp"
#include "physics/field.hpp"
#include "physics/gate.hpp"
#include "physics/map_bounds.hpp"
#include "physics/plate_theory.hpp"
#include "physics/smooth_sides.hpp"
#include "physics/statement.hpp"

namespace turnpoint::physics {

// A map stores a ratio of half-widths: that at the edge, divided by the cut-off half-width at the edge's
// frequency. On a linear taper that runs to its apex this ratio is constant, because every feature of the
// field scales with the distance from the apex. On other tapers the ratio varies slowly, and a table holds
// it.
struct BoundaryMap::State {
  Surface surface;
  MapOptions options;
  Model model;
  Taper taper;
  Dispersion dispersion;
  EdgeTable table;

  std::optional<double> position(double f) const noexcept;
  std::optional<double> frequency(double x) const noexcept;
};

std::optional<double> BoundaryMap::State::position(double f) const noexcept {
  if (!(f >= table.low_Hz && f <= table.high_Hz)) return std::nullopt;
  const auto ratio = table.ratio(f);
  if (!ratio) return std::nullopt;
  const double w = *ratio * dispersion.cut_off_half_width_m(f);
  const auto x = taper.position_continued_m(w);
  if (!x) return std::nullopt;
  const double slack = 1e-12 * surface.length_m;
  if (*x < -slack || *x > surface.length_m + slack) return std::nullopt;
  return std::clamp(*x, 0.0, surface.length_m);
}

std::optional<double> BoundaryMap::State::frequency(double x) const noexcept {
  if (!(x >= 0 && x <= surface.length_m)) return std::nullopt;
  const double w = taper.half_width_m(x);
  if (!(w > 0)) return std::nullopt;
  // Solves cut_off(w / ratio(f)) = f, with w the half-width at x, by the secant method, starting at the
  // frequency whose turning point is at x.
  const auto next = [&](double f) {
    return dispersion.cut_off_frequency_Hz(
        w / table.ratio(std::clamp(f, table.low_Hz, table.high_Hz)).value_or(1));
  };
  double f0 = std::clamp(dispersion.cut_off_frequency_Hz(w), table.low_Hz, table.high_Hz);
  double f1 = next(f0);
  double g0 = f1 - f0;
  for (int i = 0; i < 40; ++i) {
    const double g1 = next(f1) - f1;
    if (std::abs(g1) <= 1e-15 * f1 || g1 == g0) {
      f1 += g1;
      break;
    }
    const double f2 = f1 - g1 * (f1 - f0) / (g1 - g0);
    f0 = f1;
    g0 = g1;
    f1 = f2 > 0 ? f2 : 0.5 * f1;
  }
  const double slack = 1e-11;
  if (!(f1 >= table.low_Hz * (1 - slack) && f1 <= table.high_Hz * (1 + slack))) return std::nullopt;
  f1 = std::clamp(f1, table.low_Hz, table.high_Hz);
  return table.ratio(f1) ? std::optional(f1) : std::nullopt;
}

namespace {

void check(const Surface& surface, const MapOptions& options) {
  validate(surface);
  const Edge& edge = options.edge;
  validate(edge);
  if (options.friction) {
    require_size("displacement_m", options.friction->displacement_m);
    require_size_or_0("fingertip_m", options.friction->fingertip_m);
  }
  if (options.band) {
    require_size("low_Hz", options.band->low_Hz);
    require_size("high_Hz", options.band->high_Hz);
  }
  if (edge.kind == Edge::Kind::friction && !options.friction) {
    throw std::invalid_argument("a friction edge needs a friction map and a displacement");
  }
  if (options.tolerance_m) require_size("tolerance_m", *options.tolerance_m);
  require_fall(surface);
}

std::optional<double> edge_at(const Surface& surface, const MapOptions& options, double f, Model model) {
  const Wave wave = model == Model::modes ? Wave::as_modelled : Wave::exact;
  return solve_edge_m(surface, options, f, model, wave);
}

std::optional<double> first_mode_frequency_Hz(const Surface& surface, const MapOptions& options, double x,
                                              double from_Hz) {
  const Taper taper(surface);
  const Dispersion dispersion(surface);
  const double w = taper.half_width_m(x);
  // The half-width at the edge divided by the cut-off half-width varies slowly with frequency. Fixed-point
  // steps on this ratio therefore converge well, and secant steps converge faster.
  double miss_m = 0;
  const auto next = [&](double f) -> std::optional<double> {
    const auto at = edge_at(surface, options, f, Model::edge);
    if (!at) return std::nullopt;
    miss_m = std::abs(*at - x);
    return dispersion.cut_off_frequency_Hz(w * dispersion.cut_off_half_width_m(f) / taper.half_width_m(*at));
  };
  double f0 = from_Hz;
  auto f1 = next(f0);
  double g0 = f1 ? *f1 - f0 : 0;
  for (int i = 0; i < 20 && f1; ++i) {
    if (miss_m < 1e-9) return f0;
    const auto f2 = next(*f1);
    if (!f2) return std::nullopt;
    const double g1 = *f2 - *f1;
    const double better = g1 == g0 ? *f2 : *f1 - g1 * (*f1 - f0) / (g1 - g0);
    f0 = *f1;
    g0 = g1;
    f1 = better > 0.5 * f0 && better < 2 * f0 ? better : *f2;
  }
  return std::nullopt;
}

// Finds the frequency for the two-dimensional field by Newton steps. Their slope comes from the first mode,
// which is cheap to solve. Each step reduces the error about a hundredfold, so the result of the last step
// need not be checked by another solution.
std::optional<double> field_frequency_Hz(const Surface& surface, const MapOptions& options, double x,
                                         double f) {
  constexpr double last_step_m = 2e-5;
  for (int i = 0; i < 12; ++i) {
    const double aside = 1e-4 * f;
    const auto at = edge_at(surface, options, f, Model::modes);
    const auto here = edge_at(surface, options, f, Model::edge);
    const auto beside = edge_at(surface, options, f + aside, Model::edge);
    if (!at || !here || !beside || !(*beside > *here)) return std::nullopt;
    const double miss_m = x - *at;
    f += miss_m * aside / (*beside - *here);
    if (std::abs(miss_m) < last_step_m) return f;
    if (!(f > 0)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> solve_frequency_Hz(const Surface& surface, const MapOptions& options, double x,
                                         std::optional<double> near_Hz) {
  check(surface, options);
  if (near_Hz) validate(surface, *near_Hz);
  const double w = x >= 0 && x <= surface.length_m ? half_width_m(surface, x) : 0;
  if (!(w > 0)) return std::nullopt;
  const bool by_field = options.model == Model::modes && options.edge.kind != Edge::Kind::turning;
  const Surface smooth = smooth_sides(surface);
  const auto f =
      by_field && near_Hz
          ? near_Hz
          : first_mode_frequency_Hz(smooth, options, x, near_Hz.value_or(cut_off_frequency_Hz(surface, w)));
  return f && by_field ? field_frequency_Hz(smooth, options, x, *f) : f;
}

namespace {

MapAnswer no_boundary(const MapOptions& options, double x, const Reach& reach) {
  MapAnswer answer;
  answer.edge = options.edge;
  answer.model = options.model.value_or(Model::edge);
  std::ostringstream text;
  text << "no frequency puts this edge at " << x * 1e3 << " mm; it can lie from " << reach.first_m * 1e3
       << " to " << reach.last_m * 1e3 << " mm";
  answer.reason = text.str();
  return answer;
}

}  // namespace

BoundaryMap::BoundaryMap(const Surface& surface, const MapOptions& options) {
  check(surface, options);
  const Model model = options.model.value_or(Model::edge);
  const Surface smooth = smooth_sides(surface);
  state_ = std::make_unique<const State>(State{surface, options, model, Taper(smooth), Dispersion(surface),
                                               make_edge_table(smooth, options, model)});
}

BoundaryMap::~BoundaryMap() = default;
BoundaryMap::BoundaryMap(BoundaryMap&&) noexcept = default;
BoundaryMap& BoundaryMap::operator=(BoundaryMap&&) noexcept = default;

std::optional<double> BoundaryMap::boundary_m(double f) const noexcept { return state_->position(f); }
std::optional<double> BoundaryMap::frequency_Hz(double x) const noexcept { return state_->frequency(x); }
Model BoundaryMap::model() const noexcept { return state_->model; }

MapAnswer BoundaryMap::at_frequency(double f) const {
  const State& s = *state_;
  validate(s.surface, f);
  MapAnswer answer;
  answer.edge = s.options.edge;
  answer.model = s.model;
  answer.frequency_Hz = f;
  answer.boundary_m = s.position(f);
  const Tone tone{f, 1, 0};
  answer.warnings = surface_warnings(s.surface);
  for (Warning& warning : tone_warnings(s.surface, {&tone, 1})) answer.warnings.push_back(std::move(warning));
  if (!answer.boundary_m) {
    answer.reason = why_no_boundary(s.surface, s.options, f);
    return answer;
  }
  const double step = 1e-6 * f;
  const auto above = s.position(f + step), below = s.position(f - step);
  const double span = (above ? step : 0) + (below ? step : 0);
  answer.m_per_Hz = (above.value_or(*answer.boundary_m) - below.value_or(*answer.boundary_m)) / span;
  answer.shear_shift_m = shear_shift_m(s.surface, f);
  const MapBounds bounds = map_bounds(s.surface, s.options, f, *answer.boundary_m);
  answer.error_bound_m = bounds.error_m() + s.table.error_m;
  answer.uncertainty_m = boundary_budget(s.surface, f, *answer.boundary_m).total_m;
  answer.reason = s.table.closed ? "closed form" : "table of the one-mode equation";
  answer.reason += bounds.reason;
  if (s.options.tolerance_m && answer.error_bound_m > *s.options.tolerance_m) {
    std::ostringstream text;
    text << "; bound of " << answer.error_bound_m * 1e3 << " mm exceeds the tolerance of "
         << *s.options.tolerance_m * 1e3 << " mm";
    answer.reason += text.str();
  }
  return answer;
}

MapAnswer BoundaryMap::at_boundary(double x) const {
  const auto f = state_->frequency(x);
  if (!f) return no_boundary(state_->options, x, boundary_reach_m(state_->surface, state_->options));
  MapAnswer answer = at_frequency(*f);
  answer.boundary_m = x;
  return answer;
}

Reach boundary_reach_m(const Surface& surface, const MapOptions& options) {
  check(surface, options);
  const Model model = options.model.value_or(Model::edge);
  const Surface smooth = smooth_sides(surface);
  const EdgeTable table = edge_limits(smooth, options, model);
  // a closed form holds for all frequencies
  const MapOptions::Band band = options.band.value_or(MapOptions::Band{0, table.high_Hz});
  const double low_Hz = std::max(table.low_Hz, band.low_Hz), high_Hz = std::min(table.high_Hz, band.high_Hz);
  if (!(low_Hz <= high_Hz)) throw no_such_edge(options.edge);
  const auto at = [&](double f, double otherwise) {
    std::optional<double> x;
    if (table.closed && std::isfinite(f))
      x = Taper(smooth).position_continued_m(table.constant * Dispersion(surface).cut_off_half_width_m(f));
    else if (std::isfinite(f))
      x = edge_at(smooth, options, f, model);
    return std::clamp(x.value_or(otherwise), 0.0, surface.length_m);
  };
  return {at(low_Hz, 0), at(high_Hz, surface.length_m)};
}

MapAnswer answer_at_boundary(const Surface& surface, const MapOptions& options, double x) {
  try {
    if (const auto f = solve_frequency_Hz(surface, options, x)) {
      MapOptions near = options;
      near.band = MapOptions::Band{0.99 * *f, 1.01 * *f};
      const MapAnswer answer = BoundaryMap(surface, near).at_boundary(x);
      if (answer.frequency_Hz) return answer;
    }
  } catch (const std::logic_error&) {  // no boundary in this band, or no frequency with a cut-off at x
  }
  const Reach reach = boundary_reach_m(surface, options);
  if (!reach.contains(x)) return no_boundary(options, x, reach);
  return BoundaryMap(surface, options).at_boundary(x);
}

}  // namespace turnpoint::physics

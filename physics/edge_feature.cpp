#include "physics/edge_feature.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/root.hpp"
#include "physics/smooth_sides.hpp"

namespace turnpoint::physics {
namespace {

// The five-point Gauss-Legendre rule on [-1, 1].
constexpr std::array kNodes{-0.9061798459386640, -0.5384693101056831, 0.0, 0.5384693101056831,
                            0.9061798459386640};
constexpr std::array kWeights{0.2369268850561891, 0.4786286704993665, 0.5688888888888889, 0.4786286704993665,
                              0.2369268850561891};

// Solves only the part of the surface that moves (see moving_part()). It contains the mode's last maximum and
// the levels beyond. On a long taper or one with many points, this saves most of the work.
std::optional<double> marched_edge_m(const Surface& surface, const Edge& edge, double f) {
  const TaylorMarch march(Taper(surface), best_equation(surface, f, Losses::kept),
                          moving_part(surface, f).length_m);
  return edge.kind == Edge::Kind::peak ? march.last_peak_m() : march.level_m(edge.level);
}

}  // namespace

std::optional<double> solve_edge_m(const Surface& surface, const MapOptions& options, double f, Model model,
                                   Wave wave) {
  if (options.edge.kind == Edge::Kind::turning) return turning_point_m(surface, f);
  if (wave == Wave::as_modelled || Dispersion(surface).clamped_bending()) {
    const auto line = make_centre_line(surface, f, wave == Wave::as_modelled ? model : Model::mode);
    return edge_position_m(surface, f, *line, options);
  }
  const Surface smooth = smooth_sides(surface);
  const auto apex = Taper(smooth).apex_m();
  const bool pointed = apex && *apex <= surface.length_m * (1 + 1e-9);
  if (options.edge.kind != Edge::Kind::friction && !pointed) return marched_edge_m(smooth, options.edge, f);
  const auto line = make_marched_line(smooth, best_equation(surface, f, Losses::kept));
  return edge_position_m(surface, f, *line, options);
}

std::optional<double> friction_edge_m(double length_m, const CentreLine& line, const FrictionContext& context,
                                      double level) {
  const auto peak = line.last_peak_m();
  if (!peak) return std::nullopt;
  const double ln_unit = line.value(*peak).ln_magnitude() - std::log(context.displacement_m);
  const auto friction_at = [&](double x) {
    const double ln = line.value(x).ln_magnitude() - ln_unit;
    return ln < -700 ? 1.0 : context.friction.relative_friction(std::exp(ln));
  };
  const auto mean = [&](double x) {
    const double low = std::max(0.0, x - context.fingertip_m / 2);
    const double high = std::min(length_m, x + context.fingertip_m / 2);
    constexpr int panels = 4;
    double sum = 0;
    for (int p = 0; p < panels; ++p) {
      for (std::size_t i = 0; i < kNodes.size(); ++i) {
        const double t = (p + 0.5 * (1 + kNodes[i])) / panels;
        sum += 0.5 * kWeights[i] / panels * friction_at(low + t * (high - low));
      }
    }
    return sum;
  };
  // Search from the tip towards the drive edge. In this direction friction falls from 1 until the last
  // maximum, so the first crossing found is the outermost one.
  // Start one fingertip's width beyond the point where the amplitude is 1e-4 of the maximum. In every
  // friction map, the friction there is close to 1.
  const double silent = line.level_m(1e-4).value_or(length_m), quiet = silent + context.fingertip_m;
  // Friction varies over the fingertip and over the decay of the wave, whichever is longer.
  const double step =
      std::min(std::max(context.fingertip_m / 8, (silent - *peak) / 100), length_m / 100) + 1e-9 * length_m;
  double outer = std::min(length_m, quiet), f_outer = mean(outer) - level;
  if (f_outer <= 0) return std::nullopt;
  while (outer > 0) {
    double inner = std::max(0.0, outer - step);
    double f_inner = mean(inner) - level;
    if (f_inner > 0) {
      outer = inner;
      f_outer = f_inner;
      continue;
    }
    return false_position(
        {inner, f_inner, outer, f_outer}, [&](double x) { return mean(x) - level; }, {3}, 0,
        [&](const Chord& c) { return c.width() <= 1e-14 * length_m; });
  }
  return std::nullopt;
}

std::optional<double> edge_position_m(const Surface& surface, double frequency_Hz, const CentreLine& line,
                                      const MapOptions& options) {
  switch (options.edge.kind) {
    case Edge::Kind::turning:
      return turning_point_m(surface, frequency_Hz);
    case Edge::Kind::peak:
      return line.last_peak_m();
    case Edge::Kind::percent:
      return line.level_m(options.edge.level);
    case Edge::Kind::friction:
      break;
  }
  return friction_edge_m(surface.length_m, line, options.friction.value(), options.edge.level);
}

}  // namespace turnpoint::physics

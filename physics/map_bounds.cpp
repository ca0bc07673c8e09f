#include "physics/map_bounds.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/edge_feature.hpp"
#include "physics/mode_bound.hpp"

namespace turnpoint::physics {
namespace {

// whether loss counts as strong
bool strong_loss(const Surface& surface, double f) {
  return Dispersion(surface).wave_quality(f, surface.quality_factor) < 30;
}

std::optional<double> first_mode_edge(const Surface& surface, const MapOptions& options, double f) {
  try {
    return solve_edge_m(surface, options, f, Model::edge, Wave::exact);
  } catch (const std::domain_error&) {
    return std::nullopt;
  }
}

}  // namespace

MapBounds map_bounds(const Surface& surface, const MapOptions& options, double f, double x) {
  MapBounds bounds;
  if (options.edge.kind == Edge::Kind::turning) {
    bounds.reason = ": local cut-off of the first transverse mode";
    return bounds;
  }
  const auto exact = first_mode_edge(surface, options, f);
  bounds.equation_m = exact ? std::abs(*exact - x) : 0.25 * surface.length_m;
  if (bounds.equation_m < 1e-10) bounds.equation_m = 0;
  // On a wedge the best equation for the first mode is exact, so its error is 0. On every other taper, even
  // the best equation has an error.
  std::optional<double> drawn_peak_m;
  if (strong_loss(surface, f)) {
    MapOptions peak = options;
    peak.edge = Edge::peak();
    drawn_peak_m = first_mode_edge(surface, peak, f);
  }
  const ModeBound mode = mode_bound(surface, f, 1, drawn_peak_m, x);
  const bool wedge =
      std::holds_alternative<LinearTaper>(surface.taper) && !Dispersion(surface).clamped_bending();
  if (!wedge) bounds.equation_m += mode.equation_m;
  bounds.drive_modes_m = mode.drive_m;
  if (drawn_peak_m && peak_is_shallow(surface, f, *drawn_peak_m)) bounds.drive_modes_m += surface.length_m;
  bounds.reason = " of the first transverse mode";
  if (std::isfinite(surface.quality_factor)) {
    std::ostringstream loss;
    loss << " with loss (Q = " << surface.quality_factor << ")";
    bounds.reason += loss.str();
  }
  return bounds;
}

bool peak_is_shallow(const Surface& surface, double f, double last_peak_m) {
  if (!strong_loss(surface, f)) return false;
  Surface lossier = surface;
  lossier.quality_factor *= 0.75;
  const auto moved = make_centre_line(lossier, f, Model::mode)->last_peak_m();
  return !moved || std::abs(*moved - last_peak_m) > 0.5 * cut_off_half_width_m(surface, f);
}

std::string why_no_boundary(const Surface& surface, const MapOptions& options, double f) {
  std::ostringstream text;
  const Dispersion dispersion(surface);
  const double lowest = dispersion.cut_off_frequency_Hz(half_width_m(surface, 0));
  if (!(f > lowest)) {
    text << "no smooth zone: " << f << " Hz is not above the drive edge's cut-off of " << lowest << " Hz";
  } else if (!turning_point_m(surface, f)) {
    text << "turning point beyond the surface: the clamped end is the boundary";
  } else if (options.edge.kind == Edge::Kind::friction) {
    text << "friction averaged over the fingertip does not cross " << options.edge.level
         << " on the surface at this displacement";
  } else {
    text << "the last maximum would lie before the drive edge";
    if (std::isfinite(surface.quality_factor))
      text << ", or loss (Q = " << surface.quality_factor << ") hides it";
  }
  return text.str();
}

}  // namespace turnpoint::physics

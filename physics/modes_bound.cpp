#include "physics/modes_bound.hpp"

#include <algorithm>
#include <cmath>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/modal_field.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics {
namespace {

constexpr double profile_margin = 8, peak_margin = 4, edge_margin = 5;
// Two solutions may agree at one place by chance. So the bounds of level and edge come from the largest
// difference anywhere near the last maximum: the difference is divided by that maximum and multiplied by
// these factors, for the edge also by the cut-off half-width.
constexpr double level_share = 2, position_share = 1.25;
constexpr double near_rad = 3;  // phase on either side of the last maximum that counts as near
// how much larger the bounds are when the other solution is coarser, because it shares more of the error
constexpr double coarser_share = 1.5;
// largest differences that come from rounding and from effects that both solutions neglect
constexpr double floor = 1e-8;

constexpr double points_per_radian = 3;

// A solution of `modes`, scaled to a drive edge whose centre moves by exactly 1.
struct Line {
  const CentreLine* line;
  std::optional<double> peak_m;
  double ln_peak = 0;

  explicit Line(const CentreLine& solved) : line(&solved), peak_m(line->last_peak_m()) {
    if (peak_m) ln_peak = line->value(*peak_m).ln_magnitude();
  }
};

// The largest difference between two profiles, and their largest value.
struct Worst {
  double difference = 0, most = 0;
  double relative() const { return difference / most; }
  void add(double a, double b) {
    difference = std::max(difference, std::abs(a - b));
    most = std::max(most, b);
  }
};

std::optional<double> edge_m(const Line& one, const Edge& edge) {
  return edge.kind == Edge::Kind::percent ? one.line->level_m(edge.level) : one.peak_m;
}

}  // namespace

bool modes_bound_applies(const Surface& surface) {
  if (surface.theory == PlateTheory::elastic) return false;
  return surface.drive != DriveShape::piston || !Dispersion(surface).clamped_bending();
}

std::optional<ModesBound> modes_bound(const Surface& surface, double f, const Edge& edge,
                                      Comparison comparison, const CentreLine* modes) {
  ModalResolution other;
  const bool finer = comparison == Comparison::finer;
  // For comparison: the polynomials of `modes` itself have degree 7, or 5 for a thick plate.
  other.degree = finer ? 8 : surface.theory == PlateTheory::mindlin ? 4 : 6;
  other.radians = finer ? 2.2 : 2.5;
  other.spare_functions = finer ? 5 : 2;
  const auto usual = modes ? nullptr : make_modal_line(surface, f, Losses::kept, {});
  const auto compared = make_modal_line(surface, f, Losses::kept, other);
  const Line a(modes ? *modes : *usual), b(*compared);
  if (a.peak_m.has_value() != b.peak_m.has_value()) return std::nullopt;
  const double phase = wavenumber_per_m(surface, f) * surface.length_m;
  const int points = 200 + static_cast<int>(std::min(1e5, points_per_radian * phase));
  const double near_m = near_rad / wavenumber_per_m(surface, f), peak_m = a.peak_m.value_or(0);
  Worst shape, drive, near_shape, near_drive;
  for (int i = 0; i <= points; ++i) {
    const double x = surface.length_m * i / points;
    const double va = a.line->value(x).ln_magnitude(), vb = b.line->value(x).ln_magnitude();
    shape.add(std::exp(va - a.ln_peak), std::exp(vb - b.ln_peak));
    drive.add(std::exp(va), std::exp(vb));
    if (std::abs(x - peak_m) > near_m) continue;
    near_shape.add(std::exp(va - a.ln_peak), std::exp(vb - b.ln_peak));
    near_drive.add(std::exp(va), std::exp(vb));
  }
  ModesBound bound;
  bound.shape = profile_margin * shape.relative() + floor;
  bound.drive = profile_margin * drive.relative() + floor;
  const double gain = a.ln_peak - b.ln_peak;
  // Polynomials converge slowly where an element spans a steep step, so that its part of the difference
  // counts more.
  const Taper taper(surface);
  const auto steepness = [&taper](double x) { return 1 + taper.slope(x) * taper.slope(x); };
  bound.level_dB = 8.686 * (peak_margin * std::abs(gain) +
                            level_share * steepness(peak_m) * near_drive.relative() + floor);
  const auto at = edge_m(a, edge), other_at = edge_m(b, edge);
  const double cut = cut_off_half_width_m(surface, f);
  bound.position_m = cut * (position_share * (at ? steepness(*at) : 1) * near_shape.difference + floor);
  if (at.has_value() != other_at.has_value()) bound.position_m += surface.length_m;
  if (at && other_at) bound.position_m += edge_margin * std::abs(*at - *other_at);
  if (edge.kind == Edge::Kind::turning) bound.position_m = 0;
  if (finer) return bound;
  return ModesBound{coarser_share * bound.shape, coarser_share * bound.drive, coarser_share * bound.level_dB,
                    coarser_share * bound.position_m};
}

}  // namespace turnpoint::physics

#include "physics/modes_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

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
// If it is the coarsest one, and differs by less than `close` of the largest |v|, the error of `modes` is
// much smaller than the difference: at most 0.18 of it for |v| on 340 random surfaces, and on those on which
// two solutions were found to agree by chance. (Near a resonance both may be wrong by as much as they
// differ.) The margin of |v|, and what those of level and edge are multiplied by.
constexpr double close = 0.05, coarsest_profile_margin = 0.5, coarsest_share = 0.125,
                 thick_coarsest_share = 0.5, lossy_thick_share = 1, lossy_wave_below = 30;
// largest differences that come from rounding and from effects that both solutions neglect
constexpr double floor = 1e-8;

constexpr double points_per_radian = 3;

// The errors that are assumed if no higher mode resonates. The values are above the largest errors found on
// random surfaces. Plates under tension have thin boundary layers along their clamped sides. The field of a
// clamped plate's piston jumps at the corners of the drive edge. A coarse solution is never assumed to be
// better than one at the default resolution; its phase at the drive edge is less exact than |v|. With much
// loss, an error of the wavenumber changes how much the wave decays as well, by a constant over Q, and by
// more on a plate on whose wide end several modes propagate.
constexpr double membrane_accuracy = 2e-3, plate_accuracy = 2.5e-3, tense_plate_accuracy = 5e-3,
                 thick_plate_accuracy = 4e-3, plate_piston_accuracy = 0.15;
constexpr double coarse_thick_accuracy = 1e-2, coarse_tense_accuracy = 3.5e-2, coarse_membrane_phase = 3e-3,
                 coarse_plate_phase = 1.8e-2, coarse_thick_phase = 1.2e-2, coarse_decay = 0.04,
                 coarse_plate_decay = 0.12, coarse_wide_plate_decay = 0.3, coarse_thick_decay = 0.15,
                 wide = 3.2;
// how much the square of the largest slope of the sides adds to that, relative to it
constexpr double steep_share = 0.25;
// What a resonance of a higher mode adds. That of a coarse solution shows in its difference from `mode`; this
// is more than what the margins of that difference did not hold. On membranes it grows with the square,
// because a resonance that the coarse solution has at another frequency does not show at all.
constexpr double membrane_resonance = 5e-4, plate_resonance = 6e-3, thick_plate_resonance = 6e-4,
                 coarse_membrane_resonance = 1e-4, coarse_membrane_square = 2e-5,
                 coarse_plate_resonance = 7e-4;

// A solution, scaled to a drive edge whose centre moves by 1.
struct Line {
  const CentreLine* line;
  double ln_drive;
  std::optional<double> peak_m;
  double ln_peak = 0;

  Line(const CentreLine& solved, double ln_unit)
      : line(&solved), ln_drive(ln_unit), peak_m(line->last_peak_m()) {
    if (peak_m) ln_peak = ln_value(*peak_m);
  }
  double ln_value(double x) const { return line->value(x).ln_magnitude() - ln_drive; }
};

// The largest difference between two profiles, and their largest value.
struct Worst {
  static constexpr double unlimited = std::numeric_limits<double>::infinity();
  double difference = 0, most = 0;
  double relative() const { return difference / most; }
  void add(double a, double b) {
    const double apart = std::abs(a - b);
    difference = std::isnan(apart) ? unlimited : std::max(difference, apart);
    most = std::max(most, b);
  }
};

std::optional<double> edge_m(const Line& one, const Edge& edge) {
  return edge.kind == Edge::Kind::percent ? one.line->level_m(edge.level) : one.peak_m;
}

// True if the boundary layers along the clamped sides of a plate under tension, sqrt(D/N), are so thin that
// few polynomials across the strip do not follow them.
bool has_thin_layers(const Surface& surface, double f) {
  constexpr double thin = 0.2;  // of the cut-off half-width
  const double tension_N_m = line_tension_N_per_m(surface);
  const double thin_m = thin * cut_off_half_width_m(surface, f);
  return bending_stiffness_N_m(surface).value_or(0) < tension_N_m * thin_m * thin_m;
}

}  // namespace

bool modes_bound_applies(const Surface& surface) {
  if (surface.theory == PlateTheory::elastic) return false;
  return surface.drive != DriveShape::piston || !Dispersion(surface).clamped_bending();
}

AssumedError assumed_error(const Surface& surface, double f, const ModeBound& first, Resolution resolution) {
  const bool plate = Dispersion(surface).clamped_bending(), thick = surface.theory != PlateTheory::kirchhoff,
             coarse = resolution == Resolution::coarsest;
  double quiet = !plate                                ? membrane_accuracy
                 : surface.drive == DriveShape::piston ? plate_piston_accuracy
                 : surface.tension_Pa > 0              ? tense_plate_accuracy
                 : thick                               ? thick_plate_accuracy
                                                       : plate_accuracy;
  double phase = quiet;
  if (coarse) {
    if (plate && thick) quiet = std::max(quiet, coarse_thick_accuracy);
    if (plate && has_thin_layers(surface, f)) quiet = std::max(quiet, coarse_tense_accuracy);
    const bool wide_end = half_width_m(surface, 0) > wide * cut_off_half_width_m(surface, f);
    quiet += (!plate     ? coarse_decay
              : thick    ? coarse_thick_decay
              : wide_end ? coarse_wide_plate_decay
                         : coarse_plate_decay) /
             surface.quality_factor;
    phase = std::max(quiet, !plate ? coarse_membrane_phase : thick ? coarse_thick_phase : coarse_plate_phase);
  }
  const double steep = plate && !coarse ? 1 : 1 + steep_share * first.steepest * first.steepest;
  const double near = first.resonance - 1;
  const double each =
      coarse  ? plate ? coarse_plate_resonance : coarse_membrane_resonance + coarse_membrane_square * near
      : plate ? thick ? thick_plate_resonance : plate_resonance
              : membrane_resonance;
  const double resonance = each * near;
  return {quiet * steep + resonance, phase * steep + resonance};
}

std::unique_ptr<CentreLine> make_compared_line(const Surface& surface, double f, Comparison comparison) {
  if (surface.drive == DriveShape::piston && surface.theory != PlateTheory::kirchhoff)
    throw std::domain_error("model modes of a thick plate is not available for drive piston");
  const bool thick = surface.theory == PlateTheory::mindlin;
  ModalResolution
      other;  // the default resolution has degree 7, or 5 for a thick plate, and three spare functions
  switch (comparison) {
    case Comparison::finer:
      other.degree = 8, other.radians = 2.2, other.spare_functions = 5;
      break;
    case Comparison::coarser:
      other.degree = 6, other.spare_functions = thick ? 1 : 2;
      break;
    case Comparison::coarsest:
      other.degree = 4, other.spare_functions = thick ? 0 : 1;
  }
  return make_modal_line(surface, f, Losses::kept, other);
}

std::optional<LineDifference> line_difference(const Surface& surface, double f, const Edge& edge,
                                              const CentreLine& line, double ln_drive,
                                              const CentreLine& modes) {
  const Line a(line, ln_drive), b(modes, 0);
  if (a.peak_m.has_value() != b.peak_m.has_value()) return std::nullopt;
  const double k = wavenumber_per_m(surface, f);
  const int points = 200 + static_cast<int>(std::min(1e5, points_per_radian * k * surface.length_m));
  const double near_m = near_rad / k, peak_m = a.peak_m.value_or(0);
  LineDifference apart;
  Worst shape, drive, near_shape, near_drive;
  for (int i = 0; i <= points; ++i) {
    const double x = surface.length_m * i / points;
    const double va = a.ln_value(x), vb = b.ln_value(x);
    shape.add(std::exp(va - a.ln_peak), std::exp(vb - b.ln_peak));
    drive.add(std::exp(va), std::exp(vb));
    if (std::abs(x - peak_m) > near_m) continue;
    near_shape.add(std::exp(va - a.ln_peak), std::exp(vb - b.ln_peak));
    near_drive.add(std::exp(va), std::exp(vb));
  }
  // how far |v| falls from the last maximum towards the drive edge before it rises again
  double lowest = b.ln_peak;
  for (int i = b.peak_m ? static_cast<int>(*b.peak_m / surface.length_m * points) : -1; i >= 0; --i) {
    const double vb = b.ln_value(surface.length_m * i / points);
    if (vb > lowest) break;
    lowest = vb;
  }
  apart.fall = 1 - std::exp(lowest - b.ln_peak);
  apart.shape = shape.relative();
  apart.drive = drive.relative();
  apart.near_shape = near_shape.difference;
  apart.near_drive = near_drive.relative();
  apart.ln_gain = std::abs(a.ln_peak - b.ln_peak);
  apart.peak_m = a.peak_m;
  apart.at_m = edge_m(a, edge);
  const auto other = edge_m(b, edge);
  if (apart.at_m.has_value() != other.has_value()) apart.edge_m = surface.length_m;
  if (apart.at_m && other) apart.edge_m = std::abs(*apart.at_m - *other);
  const double far_m = 0.5 * cut_off_half_width_m(surface, f);
  apart.jump = apart.edge_m > far_m || (a.peak_m && std::abs(*a.peak_m - *b.peak_m) > far_m);
  return apart;
}

std::optional<ModesBound> modes_bound(const Surface& surface, double f, const Edge& edge,
                                      Comparison comparison, const CentreLine& modes,
                                      const CentreLine& compared) {
  const auto apart = line_difference(surface, f, edge, modes, 0, compared);
  if (!apart) return std::nullopt;
  // Polynomials converge slowly where an element spans a steep step, so that its part of the difference
  // counts more.
  const Taper taper(surface);
  const auto steepness = [&taper](double x) { return 1 + taper.slope(x) * taper.slope(x); };
  const bool lossy = Dispersion(surface).wave_quality(f, surface.quality_factor) < lossy_wave_below;
  const bool thick = surface.theory == PlateTheory::mindlin;
  struct Factors {
    double profile, share;
  };
  const auto factors = [&](double difference) -> Factors {
    if (comparison == Comparison::finer) return {profile_margin, 1};
    if (comparison == Comparison::coarser || !(difference < close))
      return {coarser_share * profile_margin, coarser_share};
    return {coarsest_profile_margin, !thick  ? coarsest_share
                                     : lossy ? lossy_thick_share
                                             : thick_coarsest_share};
  };
  const Factors shape = factors(apart->shape), drive = factors(apart->drive);
  // Which of two different maxima is the last one decides a small error. Then the level and the edge may be
  // those of either solution, however close the two are elsewhere.
  const auto share = [&](const Factors& of) { return apart->jump ? std::max(1.0, of.share) : of.share; };
  ModesBound bound;
  bound.jump = apart->jump;
  bound.shape = shape.profile * apart->shape + floor;
  bound.drive = drive.profile * apart->drive + floor;
  // A coarser solution of a thick plate has fewer functions, but no lower degree, so that it may agree all
  // around the last maximum; then what it differs by anywhere counts.
  const double near_drive = thick && comparison == Comparison::coarser
                                ? std::max(apart->near_drive, apart->drive)
                                : apart->near_drive;
  bound.level_dB = 8.686 * (share(drive) * (peak_margin * apart->ln_gain +
                                            level_share * steepness(apart->peak_m.value_or(0)) * near_drive) +
                            floor);
  if (edge.kind == Edge::Kind::turning) return bound;
  const double cut = cut_off_half_width_m(surface, f);
  const double near_m =
      cut * position_share * (apart->at_m ? steepness(*apart->at_m) : 1) * apart->near_shape;
  bound.position_m =
      cut * floor + std::min(share(shape) * (near_m + edge_margin * apart->edge_m), surface.length_m);
  return bound;
}

}  // namespace turnpoint::physics

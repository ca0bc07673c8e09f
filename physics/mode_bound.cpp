#include "physics/mode_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/higher_modes.hpp"
#include "physics/smooth_sides.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;

// Margins of what higher_modes() computes to first order in the slope: for |v|, for the level, and for edges.
// With a margin of 3 for all of them, the bounds were at least 2.0 and 1.5 times the true errors of |v| and
// of the level on 8242 random membranes (README.md).
constexpr double shape_margin = 1.8, gain_margin = 2.3, near_margin = 3;
// Relative error of what higher_modes() computes on small slopes: it sees the phases of the standing waves
// only to first order. The square of the slope is added.
constexpr double first_order_error = 0.1;
// Beyond this natural logarithm of the level's error, first order says nothing of it.
constexpr double first_order_gain = 2;
// Constants of the other bounds. They were measured on random surfaces, see the header. W, W' and W'' are the
// half-width and its derivatives. Shifts of an edge are in units of the cut-off half-width.
// amplitude of higher modes of a clamped plate, divided by |W'| W(0) / (cut-off half-width)
constexpr double coupling = 0.15;
constexpr double curvature_shift = 0.2;  // shift of an edge, divided by |W''| W
constexpr double slope_shift = 0.1;  // shift of an edge, divided by |W'|^3; twice this for the last maximum
// On a clamped plate, the transverse shape of `mode` is exact only at the cut-off, so its phase drifts
// between the drive edge and the cut-off.
constexpr double plate_drift = 1.7e-3;  // phase error in radians, divided by k times the turning point's x
// Of a thick plate with straight sides, `mode` has the shapes at the drive edge and at the turning point.
// With the widening of the strip between these two (the ratio of its half-widths minus 1), the phase error of
// its wave at the drive edge is at most 2.4 times
//   thick_least + widening (thick_widening + thick_slope |W'|) + thick_drift k x0 widening^3 (0.2 cut / h)^3
// on 255 random plates of the kind that straight_thick_plate() describes. The error of the level is 1.4 times
// this times the conditioning, and the error of |v| 2.5 times this.
constexpr double thick_least = 2e-4, thick_widening = 2e-3, thick_slope = 5e-3, thick_drift = 2e-4;
constexpr double thick_phase = 2.5, thick_shape = 4;
constexpr double plate_piston = 0.9;  // amplitude of higher modes for a piston drive, at any slope
// cut-off half-width of the second symmetric mode divided by that of the first
constexpr double plate_second_mode = 2.3246;
// Shift of an edge at the turning point, which occurs on every taper. The shape of `mode` is exact to first
// order in the distance a from there, so that the shift of other edges is larger, by 1 + a^2 + a^4/2 with a
// in Airy lengths. The bound is at least twice the shift of edges between the last maximum and 1 % of it.
constexpr double plate_shift = 1.2e-3;
// Tension makes a boundary layer along clamped sides, whose width does not follow W. The shape that `mode`
// uses, however, has at every W the layer that belongs to the cut-off half-width. This value is added to
// plate_shift if the layer is a third of the half-width or thinner.
constexpr double layer_shift = 4.8e-3;
// shift of an edge on any taper, for the plate theories mindlin and elastic (README.md compares it with
// finite elements)
constexpr double thick_shift = 2.5e-3, elastic_shift = 5e-3;
constexpr double plate_slope_shift = 0.15;  // shift of an edge divided by W'^2
// shift of an edge caused by a clamped end: just beyond the turning point, divided by W'^2; farther away,
// divided by W'^2 and by the wave's decay on its way to the end and back; at the turning point, divided by
// W'. Of an edge that lies beyond the turning point, close to the end, divided by W'^2.
constexpr double end_shift = 0.15, far_end_shift = 7, close_end_shift = 0.09, edge_end_shift = 0.4;
// shift of an edge, divided by the amplitude of higher modes near this edge: on a clamped plate; on a
// membrane, in Airy lengths (|v| falls by a factor of e^0.9 in an Airy length at half of the last maximum,
// and both the edge and the maximum may change by that amplitude)
constexpr double shallow = 6, airy_shift = 2.3;
// if higher modes shift the last maximum by more than this, another maximum may become the last one
constexpr double other_peak = 0.5;
// bounds are limited to these values, because larger ones would say nothing
constexpr double largest = 2, largest_dB = 120;

// Largest amplitude of a higher mode of a clamped plate divided by its amplitude at the drive edge. The
// standing wave of a higher mode is unknown here, because the higher modes of a plate are not solved for. So
// loss alone is assumed to limit the amplification.
double plate_amplification(const Surface& surface, const Taper& taper, double f) {
  const auto turning = taper.position_continued_m(plate_second_mode * cut_off_half_width_m(surface, f));
  const double reach = std::clamp(turning.value_or(0), 0.0, taper.length_m());
  const Dispersion dispersion(surface);
  const double phase = dispersion.wavenumber_per_m(f) * reach;
  return 1 / std::max(std::tanh(0.5 * phase / dispersion.wave_quality(f, surface.quality_factor)), 0.01);
}

// The factor by which the first mode decays on the way from here to the clamped end and back.
double round_trip_decay(const Surface& surface, double f, double from_m) {
  return std::exp(-2 * ln_decay(surface, f, 1, from_m, surface.length_m));
}

double curvature_times_width(const Taper& taper, double x) {
  const double w = taper.half_width_m(x);
  const double step = 0.05 * w;
  const double low = std::max(0.0, x - step), high = std::min(taper.length_m(), x + step);
  return std::abs(taper.slope(high) - taper.slope(low)) / (high - low) * w;
}

double airy_length_m(double cut, double slope) {
  return cut * std::cbrt(2 / (pi * pi * std::max(slope, 1e-6)));
}

// How steep and how curved the taper is at the places where this disturbs the first mode.
struct Steepness {
  double at_turning = 0;  // |W'| near the turning point
  double before = 0;    // largest |W'| W / (cut-off half-width) between the drive edge and the turning point
  double steepest = 0;  // largest |W'| between the drive edge and the turning point
  double bend = 0;      // largest |W''| W near the turning point
  // distance from the turning point that counts as near: two cut-off half-widths, or more where the strip is
  // nearly even
  double reach_m = 0;
};

Steepness steepness(const Taper& taper, double cut, double x0, double last_peak, double edge) {
  Steepness s;
  s.at_turning = std::max(std::abs(taper.slope(x0)), std::abs(taper.slope(std::max(0.0, x0 - 2 * cut))));
  for (int i = 0; i <= 48; ++i) {
    const double x = x0 * i / 48;
    s.steepest = std::max(s.steepest, std::abs(taper.slope(x)));
    s.before = std::max(s.before, std::abs(taper.slope(x)) * taper.half_width_m(x) / cut);
  }
  // Where the strip is nearly even, the mode decays slowly, and an edge may lie far from the turning point.
  const double airy_m = airy_length_m(cut, std::abs(taper.slope(x0)));
  s.reach_m = std::max(2 * cut, 1.2 * airy_m);
  // The last maximum and the edges beyond it are determined by the field from there to the tip. A bend
  // farther left acts on them only through higher modes, which decay within half of a cut-off half-width.
  const double left = std::min(last_peak, x0 - std::min(s.reach_m, 1.1 * airy_m + 0.5 * cut));
  const double low = std::clamp(left, 0.0, taper.length_m());
  const double high = std::clamp(std::max(x0 + 0.5 * s.reach_m, edge), 0.0, taper.length_m());
  constexpr int points = 24;
  for (int i = 0; i <= points; ++i)
    s.bend = std::max(s.bend, curvature_times_width(taper, low + (high - low) * i / points));
  return s;
}

// Shift of an edge relative to the cut-off half-width, caused by the fact that `mode` of a clamped plate has
// only one transverse shape.
double plate_shift_of(const Surface& surface, const Dispersion& dispersion, double cut) {
  if (surface.theory == PlateTheory::elastic) return elastic_shift;
  if (surface.theory == PlateTheory::mindlin) return thick_shift;
  const double layers = cut * std::sqrt(dispersion.tension_N_per_m / dispersion.stiffness_N_m);
  return plate_shift + layer_shift * std::min(1.0, layers / 3);
}

// The following two functions set the bounds of the displacement, and return a bound of the higher modes at
// `near`, relative to the first mode. `equation` is the error of |v| near the turning point that the equation
// of `mode` causes.
double bound_membrane(ModeBound& bound, const Surface& surface, double f, double near,
                      const Steepness& taper_is, double equation, double conditioning) {
  const HigherModes higher = higher_modes(surface, f, near);
  const double square = taper_is.steepest * taper_is.steepest, margin = 1 + square;
  const double gain =
      gain_margin * (higher.gain + (first_order_error + square) * higher.change) + equation * conditioning;
  bound.resonance = higher.resonance;
  bound.shape = std::min(largest, shape_margin * margin * (higher.field + higher.phase) + equation);
  bound.drive = bound.shape + std::min(1e6, std::expm1(std::min(gain, 20.0)));
  bound.level_dB = gain > first_order_gain ? largest_dB : 20 / std::numbers::ln10 * gain;
  // On sides with a slope above 1, an expansion in the slope says little: higher modes of any size may start
  // from the drive edge.
  const double unknown = std::max(0.0, square - 1) * std::exp(-ln_decay(surface, f, 2, 0, near));
  return near_margin * margin * higher.near + unknown;
}

// True for a plate for which the formula of thick_least holds: no second mode propagates, and none is trapped
// near the drive edge, where the strip is `ratio` times as wide as at the turning point.
bool straight_thick_plate(const Surface& surface, double cut, double ratio, const Steepness& taper_is) {
  const double thickness = surface.thickness_m / cut;
  return surface.theory == PlateTheory::mindlin && surface.drive == DriveShape::cosine &&
         std::holds_alternative<LinearTaper>(surface.taper) && ratio < 2.1 && taper_is.steepest <= 0.3 &&
         thickness >= 0.18 && thickness <= 0.55 && half_width_m(surface, surface.length_m) <= 0.9 * cut;
}

double bound_plate(ModeBound& bound, const Surface& surface, double f, double near, const Steepness& taper_is,
                   double equation, double conditioning) {
  const Taper taper(surface);
  const Dispersion dispersion(surface);
  const double cut = dispersion.cut_off_half_width_m(f), ratio = taper.half_width_m(0) / cut;
  const double x0 = taper.position_m(cut).value_or(taper.length_m());
  const double coupled = coupling * std::max(taper_is.before, taper_is.at_turning * ratio) +
                         coupling * taper_is.bend + (surface.drive == DriveShape::piston ? plate_piston : 0);
  bound.resonance = coupled > 0 && ratio > plate_second_mode ? plate_amplification(surface, taper, f) : 1;
  const double modes = coupled * bound.resonance;
  const double drift = plate_drift * dispersion.wavenumber_per_m(f) * x0;
  bound.shape = std::min(largest, modes + drift + equation);
  // phase error of the first mode at the drive edge
  const double phase = coupled + taper_is.bend + 1.5 * drift;
  bound.drive = std::min(1e6, bound.shape + 2 * (phase + modes) * conditioning);
  // The phase error and the higher modes may raise or lower the wave at the drive edge. Assume that they
  // lower it.
  bound.level_dB = -20 * std::log10(std::max(1e-6, 1 - (phase + modes) * conditioning));
  if (straight_thick_plate(surface, cut, ratio, taper_is)) {
    const double widening = ratio - 1, radians = dispersion.wavenumber_per_m(f) * x0;
    const double found = thick_least + widening * (thick_widening + thick_slope * taper_is.steepest) +
                         thick_drift * radians * std::pow(widening * 0.2 * cut / surface.thickness_m, 3);
    bound.shape = thick_shape * found;
    bound.drive = std::min(1e6, bound.shape * conditioning);
    bound.level_dB = -20 * std::log10(std::max(1e-6, 1 - thick_phase * found * conditioning));
  }
  return modes * std::exp(-ln_decay(surface, f, 2, 0, near));
}

// Adds the difference between two solutions, multiplied by `margin`. Both are scaled to the last maximum of
// the first, or to the drive edge if it has none.
void add_difference(SideError& error, const CentreLine& a, const CentreLine& b, double length_m, double k,
                    double margin) {
  const auto peak = a.last_peak_m(), peak_b = b.last_peak_m();
  const Scaled unit_a = a.value(peak.value_or(0)), unit_b = b.value(peak.value_or(0));
  const auto scaled = [](const Scaled& v, const Scaled& unit) {
    return v.mantissa / unit.mantissa * std::exp(std::min(600.0, v.ln_scale - unit.ln_scale));
  };
  double worst = 0, most = 0;
  for (int i = 0; i <= 300; ++i) {
    const auto va = scaled(a.value(length_m * i / 300), unit_a);
    worst = std::max(worst, std::abs(va - scaled(b.value(length_m * i / 300), unit_b)));
    most = std::max(most, std::abs(va));
  }
  error.shape += margin * worst / most;
  const auto va = scaled(a.value(0), unit_a), sa = scaled(a.slope(0), unit_a) / k;
  const auto vb = scaled(b.value(0), unit_b), sb = scaled(b.slope(0), unit_b) / k;
  error.phase +=
      margin * std::hypot(std::abs(va - vb), std::abs(sa - sb)) / std::hypot(std::abs(va), std::abs(sa));
  const auto apart = [length_m](std::optional<double> one, std::optional<double> other) {
    if (one.has_value() != other.has_value()) return length_m;
    return one ? std::abs(*one - *other) : 0;
  };
  double moved = apart(peak, peak_b);
  for (const double level : {0.9, 0.5, 0.1, 0.01})
    moved = std::max(moved, apart(a.level_m(level), b.level_m(level)));
  error.position_m += margin * moved;
}

}  // namespace

double SideError::drive(double conditioning) const {
  const double lost = std::min(phase * conditioning, 1 - 1e-6);
  return shape + lost / (1 - lost);
}

double SideError::level_dB(double conditioning) const {
  return -20 * std::log10(1 - std::min(shape + phase * conditioning, 1 - 1e-6));
}

SideError side_error(const Surface& surface, double f) {
  const Dispersion dispersion(surface);
  const bool clamped = dispersion.clamped_bending(), supported = dispersion.bending && !clamped;
  Surface smooth = smooth_sides(surface);
  Surface narrow = narrowed_sides(surface, smooth, f), rough = surface;
  const auto* table = std::get_if<TabulatedTaper>(&smooth.taper);
  const bool smoothed = table != nullptr && !table->slopes.empty();
  SideError error;
  if (!smoothed && (!supported || std::holds_alternative<LinearTaper>(surface.taper))) return error;
  smooth.length_m = rough.length_m = narrow.length_m = moving_part(smooth, f).length_m;
  const double k = dispersion.wavenumber_per_m(f), cut = dispersion.cut_off_half_width_m(f);
  const Taper even(smooth), narrower(narrow);
  const double reach = even.position_m(cut).value_or(even.length_m());
  const double ratio = even.half_width_m(0) / cut;
  const double fall =
      (even.half_width_m(0) - even.half_width_m(reach)) / std::max(reach, 1e-9 * even.length_m());
  // amplitude of a higher mode at the drive edge, relative to that of the first; see `coupling`
  const double amplitude = surface.drive == DriveShape::piston ? 1 : std::min(1.0, fall * ratio);
  for (int n = 1;; ++n) {
    // the cut-off half-width of this mode divided by that of the first
    const double wider = clamped ? (4 * n - 1) / 3.0 : 2 * n - 1;
    if (n > 1 && ratio < 0.98 * wider) break;
    MarchEquation equation = march_equation(surface, f, Losses::kept);
    equation.b *= wider * wider;
    // Curvature and width at each point matter to g and v, but not to the field across a rough strip.
    equation.c = equation.w_power = 0;
    const auto line = make_marched_line(smooth, equation);
    SideError one;
    if (smoothed) add_difference(one, *line, *make_marched_line(rough, equation), even.length_m(), k, 2);
    add_difference(one, *line, *make_marched_line(narrow, equation), even.length_m(), k, 1);
    if (n == 1)
      error = one;
    else
      error.shape += amplitude * (one.shape + one.phase * (clamped ? plate_amplification(surface, even, f)
                                                                   : line->drive_conditioning(k)));
  }
  if (!supported) return error;
  // near the sides, the field differs from that of a membrane by its slope times the narrowing
  double inwards = 0;
  for (int i = 0; i <= 64; ++i)
    inwards = std::max(inwards, even.half_width_m(reach * i / 64) - narrower.half_width_m(reach * i / 64));
  error.shape += 2 * k * inwards;
  return error;
}

ModeBound mode_bound(const Surface& given, double f, double conditioning, std::optional<double> last_peak_m,
                     std::optional<double> edge_m) {
  ModeBound bound;
  const Surface surface = smooth_sides(given);
  const Dispersion dispersion(surface);
  const Taper taper(surface);
  const double cut = dispersion.cut_off_half_width_m(f);
  const double x0 = taper.position_m(cut).value_or(taper.length_m());
  const double edge = std::max(x0, edge_m.value_or(x0));
  const Steepness taper_is = steepness(taper, cut, x0, last_peak_m.value_or(x0), edge);
  const double steepest = taper_is.at_turning, bend = taper_is.bend;
  bound.steepest = taper_is.steepest;
  const bool membrane = !dispersion.clamped_bending();
  // The outermost maximum is about one Airy length before the turning point. If the turning point is close to
  // the drive edge, the maximum is shallow, and even weak higher modes move it far.
  const double airy_length = airy_length_m(cut, steepest);
  const double near = std::max(0.0, std::min(x0 - 1.1 * airy_length, last_peak_m.value_or(x0)));
  const double equation = 0.3 * bend + slope_shift * steepest * steepest;
  const double polluted =
      membrane ? airy_shift * airy_length / cut *
                     bound_membrane(bound, surface, f, near, taper_is, equation, conditioning)
               : shallow * bound_plate(bound, surface, f, near, taper_is, equation, conditioning);
  // The curved wave fronts do not meet the straight clamped end evenly, which shifts the edge.
  const double end_width = taper.half_width_m(taper.length_m()) / cut;
  double end = std::min(end_shift, far_end_shift * round_trip_decay(surface, f, x0)) * steepest * steepest;
  if (edge > x0)
    end = std::max(end, std::min(edge_end_shift, far_end_shift * round_trip_decay(surface, f, edge)) *
                            steepest * steepest);
  end = std::max(end, close_end_shift * steepest * std::clamp((end_width - 0.75) / 0.1, 0.0, 1.0));
  // Strong higher modes near the last maximum may make another maximum the last one.
  const bool same_peak = polluted < other_peak;
  bound.drive_m = cut * (end + (same_peak ? polluted : 1)) + (same_peak ? 0 : x0);
  if (!same_peak) {
    bound.shape = bound.drive = std::max(largest, bound.drive);
    bound.level_dB = largest_dB;
  }
  const double even = std::max(taper_is.reach_m, edge - x0) / (2 * cut);
  bound.equation_m = cut * (curvature_shift * bend * even * even +
                            slope_shift * (edge_m.value_or(x0) < x0 ? 2 : 1) * std::pow(steepest, 3));
  bound.away = (edge_m.value_or(x0) - x0) / airy_length;
  if (!membrane)
    bound.equation_m += cut * (plate_shift_of(surface, dispersion, cut) *
                                   (1 + std::pow(bound.away, 2) + 0.5 * std::pow(bound.away, 4)) +
                               plate_slope_shift * steepest * steepest);
  // Strong loss moves the last maximum towards the drive edge. The edges beyond it are then less steep, and
  // the same error of the field moves them farther.
  const double stretched = (x0 - last_peak_m.value_or(x0)) / (1.5 * airy_length);
  bound.equation_m *= std::max(1.0, stretched * stretched);
  bound.sides = side_error(given, f);
  bound.equation_m += bound.sides.position_m;
  bound.shape += bound.sides.shape;
  bound.drive += bound.sides.drive(conditioning);
  bound.level_dB += bound.sides.level_dB(conditioning);
  return bound;
}

}  // namespace turnpoint::physics

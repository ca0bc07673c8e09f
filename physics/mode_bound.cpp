#include "physics/mode_bound.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/taper.hpp"
#include "physics/taylor_march.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;

// Constants of the bounds. They were measured on random surfaces, see the header. W, W' and W'' are the
// half-width and its derivatives. Shifts of an edge are in units of the cut-off half-width.
constexpr double coupling = 0.15;  // amplitude of higher modes, divided by |W'| W(0) / (cut-off half-width)
constexpr double piston_coupling = 0.55;  // amplitude of higher modes for a piston drive, at any slope
// uncertainty of the phase of a higher mode's standing wave at the drive edge
constexpr double phase_uncertainty = 0.12;
constexpr double curvature_shift = 0.2;  // shift of an edge, divided by |W''| W
constexpr double slope_shift = 0.1;      // shift of an edge, divided by |W'|^3
// On a clamped plate, the transverse shape of `mode` is exact only at the cut-off, so its phase drifts
// between the drive edge and the cut-off.
constexpr double plate_drift = 1.5e-3;  // phase error in radians, divided by k times the turning point's x
constexpr double plate_piston = 0.9;
// cut-off half-width of the second symmetric mode divided by that of the first
constexpr double plate_second_mode = 2.3246;
constexpr double plate_shift = 1.2e-3;  // shift of an edge, which occurs on every taper
// Tension makes a boundary layer along clamped sides, whose width does not follow W. The shape that `mode`
// uses, however, has at every W the layer that belongs to the cut-off half-width. This value is added to
// plate_shift if the layer is a third of the half-width or thinner.
constexpr double layer_shift = 4.8e-3;
// shift of an edge on any taper, for the plate theories mindlin and elastic
constexpr double thick_shift = 2.5e-3;
constexpr double plate_slope_shift = 0.15;  // shift of an edge divided by W'^2
// shift of an edge caused by a clamped end: just beyond the turning point, divided by W'^2; farther away,
// divided by W'^2 and by the wave's decay on its way to the end and back; at the turning point, divided by W'
constexpr double end_shift = 0.15, far_end_shift = 7, close_end_shift = 0.09;
// shift of an edge, divided by the amplitude of higher modes near this edge
constexpr double shallow = 6;
// if higher modes shift the last maximum by more than this, another maximum may become the last one
constexpr double other_peak = 0.5;
constexpr double largest = 2;  // bounds are limited to this value, because a larger one would say nothing

// The equation of the n-th symmetric transverse mode, n = 1, 2, ... On a wedge the solution is a Bessel
// function; its order is accurate up to the square of the slope.
MarchEquation equation(const Surface& surface, double f, int n) {
  const double k = wavenumber_per_m(surface, f);
  const std::complex<double> lossy(1, -0.5 / surface.quality_factor);
  const double odd = 2 * n - 1;
  MarchEquation e;
  e.a = k * k * lossy * lossy;
  e.b = odd * odd * pi * pi / 4;
  e.c = odd * odd * pi * pi / 6 - 0.25;
  e.w_power = 0.5;
  return e;
}

// Largest amplitude of a higher mode on the surface divided by its amplitude at the drive edge.
double amplification(const Surface& surface, double f, int n) {
  const bool linear = std::holds_alternative<LinearTaper>(surface.taper);
  const Taper taper(linear ? surface : moving_part(surface, f));
  const double k = wavenumber_per_m(surface, f);
  const auto turning = taper.position_continued_m((2 * n - 1) * cut_off_half_width_m(surface, f));
  const double reach = std::clamp(turning.value_or(taper.length_m()), 0.0, taper.length_m());
  const double loss = std::tanh(0.5 * k * reach / surface.quality_factor);
  const TaylorMarch march(taper, equation(surface, f, n));
  const double ln_drive = march.value(0).ln_magnitude();
  double most = ln_drive;
  for (int i = 1; i <= 200; ++i) most = std::max(most, march.value(reach * i / 200).ln_magnitude());
  // Near a resonance, the amplitude of the standing wave at the drive edge depends on its phase, which is
  // known only to `phase_uncertainty`.
  const double standing = std::exp(ln_drive - most);
  return 1 / std::max({standing - phase_uncertainty, loss, 1e-3});
}

// Like amplification(), for a clamped plate. The standing wave of a higher mode is unknown here, because the
// higher modes of a plate are not solved for. So loss alone is assumed to limit the amplification.
double plate_amplification(const Surface& surface, const Taper& taper, double f) {
  const auto turning = taper.position_continued_m(plate_second_mode * cut_off_half_width_m(surface, f));
  const double reach = std::clamp(turning.value_or(0), 0.0, taper.length_m());
  return 1 / std::max(std::tanh(0.5 * wavenumber_per_m(surface, f) * reach / surface.quality_factor), 0.01);
}

// Natural logarithm of the factor by which the n-th symmetric mode decays from one position to another, where
// the strip is too narrow for it.
double ln_decay(const Surface& surface, double f, int n, double from_m, double to_m) {
  const Taper taper(surface);
  const double k = wavenumber_per_m(surface, f);
  double ln = 0;
  constexpr int panels = 24;
  for (int i = 0; i < panels; ++i) {
    const double w = taper.half_width_m(from_m + (to_m - from_m) * (i + 0.5) / panels);
    const double across = (2 * n - 1) * pi / (2 * w);
    ln += (to_m - from_m) / panels * std::sqrt(std::max(0.0, across * across - k * k));
  }
  return ln;
}

// The factor by which the first mode decays on the way from the turning point to the clamped end and back.
double round_trip_decay(const Surface& surface, double f, double turning_point_m) {
  return std::exp(-2 * ln_decay(surface, f, 1, turning_point_m, surface.length_m));
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
  double before = 0;  // largest |W'| W / (cut-off half-width) between the drive edge and the turning point
  double bend = 0;    // largest |W''| W near the turning point
  // distance from the turning point that counts as near: two cut-off half-widths, or more where the strip is
  // nearly even
  double reach_m = 0;
};

Steepness steepness(const Taper& taper, double cut, double x0, double last_peak) {
  Steepness s;
  s.at_turning = std::max(std::abs(taper.slope(x0)), std::abs(taper.slope(std::max(0.0, x0 - 2 * cut))));
  for (int i = 0; i <= 48; ++i) {
    const double x = x0 * i / 48;
    s.before = std::max(s.before, std::abs(taper.slope(x)) * taper.half_width_m(x) / cut);
  }
  // Where the strip is nearly even, the mode decays slowly, and an edge may lie far from the turning point.
  s.reach_m = std::max(2 * cut, 1.2 * airy_length_m(cut, std::abs(taper.slope(x0))));
  const double low = std::clamp(std::min(x0 - s.reach_m, last_peak), 0.0, taper.length_m());
  const double high = std::clamp(x0 + 0.5 * s.reach_m, 0.0, taper.length_m());
  constexpr int points = 24;
  for (int i = 0; i <= points; ++i)
    s.bend = std::max(s.bend, curvature_times_width(taper, low + (high - low) * i / points));
  return s;
}

// Shift of an edge relative to the cut-off half-width, caused by the fact that `mode` of a clamped plate has
// only one transverse shape.
double plate_shift_of(const Surface& surface, const Dispersion& dispersion, double cut) {
  if (surface.theory != PlateTheory::kirchhoff) return thick_shift;
  const double layers = cut * std::sqrt(dispersion.tension_N_per_m / dispersion.stiffness_N_m);
  return plate_shift + layer_shift * std::min(1.0, layers / 3);
}

}  // namespace

double higher_mode_decay(const Surface& surface, double f, double x) {
  return std::exp(-ln_decay(surface, f, 2, 0, x));
}

ModeBound mode_bound(const Surface& surface, double f, double conditioning,
                     std::optional<double> last_peak_m) {
  ModeBound bound;
  const Dispersion dispersion(surface);
  const Taper taper(surface);
  const double cut = dispersion.cut_off_half_width_m(f);
  const double ratio = taper.half_width_m(0) / cut;
  const double x0 = taper.position_m(cut).value_or(taper.length_m());
  const Steepness taper_is = steepness(taper, cut, x0, last_peak_m.value_or(x0));
  const double steepest = taper_is.at_turning, bend = taper_is.bend;
  const bool membrane = !dispersion.clamped_bending();
  const bool piston = surface.drive == DriveShape::piston;
  const double coupled = coupling * std::max(taper_is.before, steepest * ratio) + coupling * bend +
                         (!piston    ? 0
                          : membrane ? piston_coupling
                                     : plate_piston);
  double modes = coupled;
  for (int n = 2; membrane && 2 * n - 1 < ratio; ++n) {
    modes = std::max(modes, coupled / (n - 1) * amplification(surface, f, n));
  }
  const double drift = membrane ? 0 : plate_drift * dispersion.wavenumber_per_m(f) * x0;
  if (!membrane && ratio > plate_second_mode) modes *= plate_amplification(surface, taper, f);
  bound.resonance = coupled > 0 ? modes / coupled : 1;
  bound.higher_modes = std::min(largest, modes);
  bound.shape = std::min(largest, modes + drift + 0.3 * bend + slope_shift * steepest * steepest);
  const double phase = coupled + bend + 1.5 * drift;  // phase error of the first mode at the drive edge
  bound.drive = std::min(1e6, bound.shape + 2 * (phase + modes) * conditioning);
  // The phase error and the higher modes may raise or lower the wave at the drive edge. Assume that they
  // lower it.
  bound.level_dB = -20 * std::log10(std::max(1e-6, 1 - (phase + modes) * conditioning));
  // The outermost maximum is about one Airy length before the turning point. If the turning point is close to
  // the drive edge, the maximum is shallow, and even weak higher modes move it far.
  const double airy_length = airy_length_m(cut, steepest);
  const double near = std::max(0.0, std::min(x0 - 1.1 * airy_length, last_peak_m.value_or(x0)));
  const double polluted = shallow * modes * higher_mode_decay(surface, f, near);
  // The curved wave fronts do not meet the straight clamped end evenly, which shifts the edge.
  const double end_width = taper.half_width_m(taper.length_m()) / cut;
  double end = std::min(end_shift, far_end_shift * round_trip_decay(surface, f, x0)) * steepest * steepest;
  end = std::max(end, close_end_shift * steepest * std::clamp((end_width - 0.75) / 0.1, 0.0, 1.0));
  // Strong higher modes near the last maximum may make another maximum the last one.
  const bool same_peak = polluted < other_peak;
  bound.drive_m = cut * (end + (same_peak ? polluted : 1)) + (same_peak ? 0 : x0);
  if (!same_peak) {
    bound.shape = bound.drive = std::max(largest, bound.drive);
    bound.level_dB = 120;
  }
  const double even = taper_is.reach_m / (2 * cut);
  bound.equation_m = cut * (curvature_shift * bend * even * even + slope_shift * std::pow(steepest, 3));
  if (!membrane)
    bound.equation_m +=
        cut * (plate_shift_of(surface, dispersion, cut) + plate_slope_shift * steepest * steepest);
  // Strong loss moves the last maximum towards the drive edge. The edges beyond it are then less steep, and
  // the same error of the field moves them farther.
  const double stretched = (x0 - last_peak_m.value_or(x0)) / (1.5 * airy_length);
  bound.equation_m *= std::max(1.0, stretched * stretched);
  return bound;
}

}  // namespace turnpoint::physics

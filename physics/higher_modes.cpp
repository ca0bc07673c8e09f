#include "physics/higher_modes.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/operations.hpp"
#include "physics/taper.hpp"
#include "physics/taylor_march.hpp"

namespace turnpoint::physics {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

// uncertainty of the phase of a higher mode's standing wave at the drive edge
constexpr double phase_uncertainty = 0.12;
// Error of a propagating mode's phase at the drive edge: on a wedge, and in addition the share of the phase
// by which curved sides shift the mode.
constexpr double wedge_phase_error = 0.05, curved_phase_error = 0.3;
constexpr double least_determinant = 1e-3;  // resonances are not assumed to be sharper than this
constexpr int extra_modes = 3;   // number of modes that the drive edge excites beyond those that propagate
constexpr int edge_points = 32;  // number of points across half of the drive edge

// The shape of the n-th symmetric mode is cos(q y/W), n = 1, 2, ...
double transverse_q(int n) { return (2 * n - 1) * pi / 2; }

// Projection of (y/W)^2 cos(q y/W) on the n-th mode, with the q of another mode, the m-th.
double projection_on_other(int m, int n) {
  return ((n - m) % 2 == 0 ? 2 : -2) / (pi * pi) * (1 / std::pow(n - m, 2) - 1 / std::pow(n + m - 1, 2));
}

// Projection of (y/W)^2 cos(q y/W) on itself.
double projection_on_itself(int n) { return 1.0 / 3 - 0.5 / std::pow(transverse_q(n), 2); }

// The equation of the n-th mode. On a wedge the solution is a Bessel function; its order is accurate up to
// the square of the slope.
MarchEquation mode_equation(const Surface& surface, double f, int n) {
  const double k = wavenumber_per_m(surface, f), q = transverse_q(n);
  const Complex lossy = Dispersion(surface).loss(f, surface.quality_factor);
  return {k * k * lossy * lossy, q * q, 2.0 / 3 * q * q - 0.25, 0.5};
}

// One mode. Near the drive edge, v(x) = cosine cos(kx x) + sine sin(kx x), and |v|^2 + |v'/k|^2 = 1 at x = 0.
// It vanishes at the tip. The other solution, conj(cosine) sin(kx x) - conj(sine) cos(kx x), does not.
struct ModeWave {
  Complex kx, cosine, sine;
  double most = 1, near = 0;  // largest |v|, and sqrt(|v|^2 + |v'/k|^2) at near_m
  // phase by which curved sides shift the mode on its way from the drive edge, and the sum of its absolute
  // parts
  double turn = 0, turns = 0;
  double phase_error = 0;
  // g = sqrt(W) v and dg/dx at each of the points along curved sides
  std::vector<Complex> g, g_slope;
};

// A point between the drive edge and the turning point of the first mode. Sums over these points stand for
// integrals along the surface.
struct CurvedPoint {
  double x, w, bend;  // bend: W W''
};

struct ModeWaves {
  Taper taper;
  double k;
  Complex lossy_k;
  double near_m, reach_m;  // reach_m is the turning point of the first mode
  bool curved;
  std::vector<CurvedPoint> points;
  std::vector<ModeWave> modes;
  // amplitude of the other solution of mode n that mode m excites on curved sides
  Eigen::MatrixXcd excited;
  double resonance = 1;

  ModeWaves(const Surface& surface, double f, double near);
  void add_propagating(const Surface& surface, double f, int n);
  void add_evanescent(const Surface& surface, double f, int n);
  // The wavenumber along x, if q is that across; not exactly 0, so that one can divide by it.
  Complex along(double q) const { return std::sqrt(lossy_k * lossy_k - q * q + 1e-12 * k * k); }
  void turn(ModeWave& wave, int n) const;
  void flow(ModeWave& wave, const TaylorMarch& march, double ln_unit, double end_m) const;
  Complex excited_by(std::size_t m, std::size_t n) const;
};

ModeWaves::ModeWaves(const Surface& surface, double f, double near)
    : taper(std::holds_alternative<LinearTaper>(surface.taper) ? surface : moving_part(surface, f)),
      k(wavenumber_per_m(surface, f)),
      lossy_k(k * Dispersion(surface).loss(f, surface.quality_factor)),
      near_m(std::min(near, taper.length_m())),
      reach_m(taper.position_m(cut_off_half_width_m(surface, f)).value_or(taper.length_m())),
      curved(!std::holds_alternative<LinearTaper>(surface.taper)) {
  // The product of two modes oscillates at most twice as fast as one, so one point per 1.5 radians suffices.
  if (curved) points.resize(60 + static_cast<std::size_t>(std::min(1e5, k * reach_m / 1.5)));
  for (std::size_t i = 0; i < points.size(); ++i) {
    CurvedPoint& point = points[i];
    point.x = reach_m * (static_cast<double>(i) + 0.5) / static_cast<double>(points.size());
    point.w = taper.half_width_m(point.x);
    point.bend = point.w * taper.second_derivative(point.x);
  }
  const double ratio = taper.half_width_m(0) / cut_off_half_width_m(surface, f);
  int n = 1;
  for (; n == 1 || 2 * n - 1 < ratio; ++n) add_propagating(surface, f, n);
  const int propagating = n - 1;
  for (const int last = n + extra_modes; n < last; ++n) add_evanescent(surface, f, n);
  excited = Eigen::MatrixXcd::Zero(n - 1, n - 1);
  if (!curved || propagating == 1) return;
  for (std::size_t from = 0; from < static_cast<std::size_t>(propagating); ++from)
    for (std::size_t to = 0; to < static_cast<std::size_t>(propagating); ++to)
      if (from != to)
        excited(static_cast<Eigen::Index>(to), static_cast<Eigen::Index>(from)) = excited_by(from, to);
}

// The phase is the integral of kx (y/W)^2 W W''/2, projected on the mode.
void ModeWaves::turn(ModeWave& wave, int n) const {
  for (const CurvedPoint& point : points) {
    const double q = transverse_q(n) / point.w;
    const double part = 0.5 * projection_on_itself(n) * std::sqrt(std::max(0.0, k * k - q * q)) * point.bend *
                        reach_m / static_cast<double>(points.size());
    wave.turn += part;
    wave.turns += std::abs(part);
  }
}

// Computes g and dg/dx of a mode, which is negligible beyond end_m.
void ModeWaves::flow(ModeWave& wave, const TaylorMarch& march, double ln_unit, double end_m) const {
  wave.g.assign(points.size(), 0), wave.g_slope.assign(points.size(), 0);
  for (std::size_t i = 0; i < points.size() && points[i].x <= end_m; ++i) {
    const CurvedPoint& point = points[i];
    const auto [value, derivative] = march.motion(point.x);
    const double root = std::sqrt(point.w);
    wave.g[i] = root * std::exp(value.ln_scale - ln_unit) * value.mantissa;
    wave.g_slope[i] = root * std::exp(derivative.ln_scale - ln_unit) * derivative.mantissa +
                      0.5 * taper.slope(point.x) / point.w * wave.g[i];
  }
}

// In coordinates that follow the arcs, x + W W' (y/W)^2/2, the Laplacian of a mode g has the extra terms
// (y/W)^2 (W W'' g'' + (W W'')' g'/2). They drive the other modes. The sum is the product of another mode
// with them, integrated by parts. `m` and `n` count from 0.
Complex ModeWaves::excited_by(std::size_t m, std::size_t n) const {
  const ModeWave &from = modes[m], &to = modes[n];
  const int m1 = static_cast<int>(m) + 1, n1 = static_cast<int>(n) + 1;
  Complex sum = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double q = transverse_q(m1) / points[i].w;
    sum += 0.5 * points[i].bend *
           ((lossy_k * lossy_k - q * q) * from.g[i] * to.g[i] + from.g_slope[i] * to.g_slope[i]);
  }
  count_operations(25 * static_cast<double>(points.size()));
  sum *= reach_m / static_cast<double>(points.size());
  const double w = taper.half_width_m(0);
  sum += 0.5 * w * w * taper.second_derivative(0) * from.sine * from.kx * to.cosine;
  return -projection_on_other(m1, n1) * sum / (w * to.kx * (std::norm(to.cosine) + std::norm(to.sine)));
}

// sqrt(|v|^2 + |v'/k|^2)
double wave_envelope(const Scaled& value, const Scaled& slope, double k, double ln_unit) {
  return std::hypot(std::abs(value.mantissa) * std::exp(value.ln_scale - ln_unit),
                    std::abs(slope.mantissa) * std::exp(slope.ln_scale - ln_unit) / k);
}

void ModeWaves::add_propagating(const Surface& surface, double f, int n) {
  const TaylorMarch march(taper, mode_equation(surface, f, n));
  const double w = taper.half_width_m(0), q = transverse_q(n) / w, cut = cut_off_half_width_m(surface, f);
  const auto [value, slope] = march.motion(0);
  const double ln_unit = std::log(wave_envelope(value, slope, k, value.ln_scale)) + value.ln_scale;
  ModeWave wave;
  wave.kx = along(q);
  wave.cosine = value.mantissa * std::exp(value.ln_scale - ln_unit);
  wave.sine = slope.mantissa * std::exp(slope.ln_scale - ln_unit) / wave.kx;
  const TaylorMarch::Motion near = march.motion(near_m);
  wave.near = wave_envelope(near.value, near.slope, k, ln_unit);
  if (curved) turn(wave, n);
  wave.phase_error = wedge_phase_error + curved_phase_error * wave.turns;
  if (n == 1) {
    wave.most = std::max(wave.near, std::abs(wave.cosine));
    const bool alone = 3 * cut >= w;  // no other mode propagates
    if (curved && !alone) flow(wave, march, ln_unit, reach_m);
  } else {
    const auto turning = taper.position_continued_m((2 * n - 1) * cut);
    const double reach = std::clamp(turning.value_or(taper.length_m()), 0.0, taper.length_m());
    double ln_most = value.ln_magnitude();
    for (int i = 1; i <= 200; ++i) ln_most = std::max(ln_most, march.value(reach * i / 200).ln_magnitude());
    wave.most = std::exp(ln_most - ln_unit);
    if (curved) flow(wave, march, ln_unit, reach + 2 * cut);
    // Near a resonance, the amplitude of the standing wave at the drive edge depends on its phase, which is
    // known only to `phase_uncertainty`.
    const double standing = std::exp(value.ln_magnitude() - ln_most);
    const double loss =
        std::tanh(0.5 * k * reach / Dispersion(surface).wave_quality(f, surface.quality_factor));
    resonance = std::max(resonance, 1 / std::max({standing - phase_uncertainty, loss, 1e-3}) / (n - 1));
  }
  modes.push_back(wave);
}

void ModeWaves::add_evanescent(const Surface& surface, double f, int n) {
  const double w = taper.half_width_m(0), q = transverse_q(n) / w;
  ModeWave wave;
  wave.kx = along(q);
  if (wave.kx.imag() < 0) wave.kx = -wave.kx;  // exp(i kx x) decays
  wave.cosine = 1;
  wave.sine = Complex(0, 1) - 0.5 * taper.slope(0) / (w * wave.kx);
  wave.near = std::exp(-ln_decay(surface, f, n, 0, near_m));
  modes.push_back(wave);
}

// The modes in the coordinates of the arcs, projected on the shapes cos(q y/W) of the straight drive edge:
// one matrix for v = cos(kx x) and one for v = sin(kx x). On a wedge of slope d, the distance from the apex
// is W/d sqrt(1 + (d y/W)^2), and the angle is atan(d y/W).
struct DriveEdgeModes {
  Eigen::MatrixXcd cosine, sine;
  Eigen::VectorXcd drive;

  DriveEdgeModes(const ModeWaves& waves, DriveShape shape);
};

DriveEdgeModes::DriveEdgeModes(const ModeWaves& waves, DriveShape shape) {
  const auto count = static_cast<Eigen::Index>(waves.modes.size());
  cosine = sine = Eigen::MatrixXcd::Zero(count, count);
  drive = Eigen::VectorXcd::Zero(count);
  // a row of shapes, two sines and two cosines of a complex number for each point and mode
  count_operations(edge_points * static_cast<double>(count) *
                   (4 * function_operations + 4.0 * static_cast<double>(count)));
  const double w = waves.taper.half_width_m(0), d = std::max(1e-6, std::abs(waves.taper.slope(0)));
  for (int i = 0; i < edge_points; ++i) {
    const double eta = (i + 0.5) / edge_points, angle = std::atan(d * eta) / std::atan(d);
    const double x = -w * d * eta * eta / (1 + std::sqrt(1 + d * d * eta * eta));
    Eigen::VectorXd shapes(count);
    for (Eigen::Index m = 0; m < count; ++m) shapes(m) = 2.0 / edge_points * std::cos((m + 0.5) * pi * eta);
    drive += shapes * (shape == DriveShape::piston ? 1 : std::cos(pi * eta / 2));
    for (Eigen::Index n = 0; n < count; ++n) {
      const Complex phase = waves.modes[static_cast<std::size_t>(n)].kx * x;
      const double turned = std::cos((n + 0.5) * pi * angle);
      cosine.col(n) += shapes * (std::cos(phase) * turned);
      sine.col(n) += shapes * (std::sin(phase) * turned);
    }
  }
}

// Solves for the amplitudes of the modes, with the effects of curvature multiplied by `curvature`, and keeps
// the largest results. The phase of the n-th mode is known to phase_error only. If it is off by psi, the
// determinant of the equations is multiplied by cos psi + r sin psi, which is small near a resonance.
void solve_drive_edge(const ModeWaves& waves, const DriveEdgeModes& edge, double curvature,
                      HigherModes& all) {
  const auto count = static_cast<Eigen::Index>(waves.modes.size());
  Eigen::MatrixXcd matrix(count, count),
      turned(count, count);               // turned: derivative by the phase of each mode
  Eigen::MatrixXcd others(count, count);  // the other solution of each mode
  for (Eigen::Index n = 0; n < count; ++n) {
    const ModeWave& wave = waves.modes[static_cast<std::size_t>(n)];
    const double c = std::cos(curvature * wave.turn), s = std::sin(curvature * wave.turn);
    const Complex cosine = wave.cosine * c + wave.sine * s, sine = wave.sine * c - wave.cosine * s;
    matrix.col(n) = edge.cosine.col(n) * cosine + edge.sine.col(n) * sine;
    turned.col(n) = edge.cosine.col(n) * sine - edge.sine.col(n) * cosine;
    others.col(n) = edge.sine.col(n) * std::conj(wave.cosine) - edge.cosine.col(n) * std::conj(wave.sine);
  }
  matrix += curvature * others * waves.excited;
  count_factorisation(static_cast<double>(count), static_cast<double>(count) + 1);
  count_operations(30 * static_cast<double>(count * count));
  const Eigen::PartialPivLU<Eigen::MatrixXcd> solver(matrix);
  const Eigen::VectorXcd amplitude = solver.solve(edge.drive);
  const Eigen::MatrixXcd effect = solver.solve(turned);
  Eigen::VectorXd spread = Eigen::VectorXd::Zero(count);  // uncertainty of each amplitude
  for (Eigen::Index n = 1; n < count; ++n) {
    const double error = waves.modes[static_cast<std::size_t>(n)].phase_error;
    const Complex r = effect(n, n);
    const double psi = std::clamp(-r.real() / std::max(1e-300, std::norm(r)), -error, error);
    const double resonant = 1 / std::max(least_determinant, std::abs(1.0 + r * psi));
    spread += error * std::abs(amplitude(n)) * resonant * effect.col(n).cwiseAbs();
  }
  const double certain = std::max(least_determinant, 1 - spread(0) / std::abs(amplitude(0)));
  const double first = std::abs(amplitude(0)) * certain;
  double field = 0, near = 0;
  for (Eigen::Index n = 1; n < count; ++n) {
    const ModeWave& wave = waves.modes[static_cast<std::size_t>(n)];
    const double size =
        (std::abs(amplitude(n)) + spread(n)) / first + std::abs(curvature * waves.excited(n, 0));
    field += size * wave.most / waves.modes[0].most;
    near += size * wave.near / waves.modes[0].near;
  }
  const Complex factor = amplitude(0) * waves.modes[0].cosine;
  all.field = std::max(all.field, field);
  all.near = std::max(all.near, near);
  all.gain = std::max(all.gain, std::abs(std::log(std::abs(factor))) - std::log(certain));
  all.change = std::max(all.change, std::abs(1.0 / factor - 1.0));
}

}  // namespace

HigherModes higher_modes(const Surface& surface, double f, double near_m) {
  const ModeWaves waves(surface, f, near_m);
  const DriveEdgeModes edge(waves, surface.drive);
  HigherModes all;
  all.phase = waves.modes[0].turns / waves.modes[0].most;
  all.resonance = waves.resonance;
  for (const double curvature : {0.0, 1.0, 2.0}) {
    solve_drive_edge(waves, edge, curvature, all);
    if (!waves.curved) break;
  }
  return all;
}

double ln_decay(const Surface& surface, double f, int n, double from_m, double to_m) {
  const Taper taper(surface);
  const double k = wavenumber_per_m(surface, f);
  double ln = 0;
  constexpr int panels = 24;
  for (int i = 0; i < panels; ++i) {
    const double w = taper.half_width_m(from_m + (to_m - from_m) * (i + 0.5) / panels);
    const double q = transverse_q(n) / w;
    ln += (to_m - from_m) / panels * std::sqrt(std::max(0.0, q * q - k * k));
  }
  return ln;
}

}  // namespace turnpoint::physics

#include "tests/physics/collocated_equations.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "physics/mindlin_plate.hpp"

namespace turnpoint::physics_test {
namespace {

using physics::Surface;
using physics::Taper;
using std::numbers::pi;
using Real = Eigen::MatrixXd;
using Index = Eigen::Index;

// Matrices that differentiate functions of eta, given their values at the points between 0 and 1.
struct Across {
  Eigen::VectorXd eta;
  // give the first and second derivatives of even and of odd functions that vanish at eta = 1
  Real even1, even2, odd1, odd2;
  // give what the value at eta = 1 adds to the first and second derivatives of an even function
  Eigen::VectorXd side1, side2;
  // give the first and second derivative of an even function whose value and slope vanish at eta = 1
  Real clamped1, clamped2;
  Eigen::RowVectorXd clamped_side;  // gives the second derivative of such a function at eta = 1
  Eigen::RowVectorXd centre;        // gives the value at eta = 0 of an even function that vanishes at eta = 1

  explicit Across(int points) {
    const int n = points, last = 2 * n + 1;  // `last` is an odd number, so that there is no point at 0
    const Eigen::VectorXd t = chebyshev_points(last);
    const Real d = differentiation(t), dd = d * d;
    eta = t.segment(n + 1, n);
    const auto fold = [n](const Real& full, int row, double sign) {
      Real half = full.block(row, n + 1, row == n + 1 ? n : 1, n);
      for (int j = 0; j < n; ++j) half.col(j) += sign * full.col(n - j).segment(row, half.rows());
      return half;
    };
    even1 = fold(d, n + 1, 1), even2 = fold(dd, n + 1, 1);
    odd1 = fold(d, n + 1, -1), odd2 = fold(dd, n + 1, -1);
    side1 = (d.col(last) + d.col(0)).segment(n + 1, n);
    side2 = (dd.col(last) + dd.col(0)).segment(n + 1, n);
    // v = (1 - eta^2) q, where q is even and vanishes at 1
    const Eigen::VectorXd hat = 1 - eta.array().square();
    const Real q = hat.cwiseInverse().asDiagonal();
    clamped1 = hat.asDiagonal() * even1 * q - 2 * Real(eta.asDiagonal()) * q;
    clamped2 = hat.asDiagonal() * even2 * q - 4 * (eta.asDiagonal() * even1 * q) - 2 * q;
    clamped_side = -4 * (fold(d, last, 1) * q);
    centre.resize(n);
    for (int j = 0; j < n; ++j) {  // Lagrange's polynomials in eta^2 at 0
      centre[j] = 1;
      for (int i = 0; i <= n; ++i) {
        const double other = i == n ? 1 : eta[i] * eta[i];
        if (i != j) centre[j] *= -other / (eta[j] * eta[j] - other);
      }
    }
  }
};

// The strip at one x, in units of 1/k. The coordinates are x and eta = y / W(x). A derivative with respect to
// x at constant y is a sum of derivatives with respect to x (at constant eta) and eta, with the following
// factors.
struct Strip {
  Eigen::ArrayXd eta;
  double w, slope, r, curve;

  Strip(const Taper& taper, double k, const Eigen::VectorXd& points, double x)
      : eta(points),
        w(k * taper.half_width_m(x)),
        slope(taper.slope(x)),
        r(slope / w),
        curve(taper.second_derivative(x) / k / w) {}

  // first derivative at constant y: d/dx + along_once() d/deta
  Eigen::VectorXd along_once() const { return -r * eta; }
  // second derivative at constant y: d2/dx2 + mixed() d2/(dx deta) + once() d/deta + along_twice() d2/deta2
  Eigen::VectorXd mixed() const { return -2 * r * eta; }
  Eigen::VectorXd once() const { return (2 * r * r - curve) * eta; }
  Eigen::VectorXd along_twice() const { return r * r * eta.square(); }
  // factor of d2/deta2 in the whole Laplacian
  Eigen::VectorXd twice() const { return r * r * eta.square() + 1 / (w * w); }
};

// k (1 - i g/2Q), g = (omega/k) dk/domega: Q is what a resonance curve shows.
std::complex<double> lossy(const Surface& s, double k) {
  if (s.theory == physics::PlateTheory::mindlin) return {1, -0.25 / s.quality_factor};
  const double bent = physics::bending_modelled(s) ? *physics::bending_stiffness_N_m(s) * k * k : 0;
  const double tension = physics::line_tension_N_per_m(s);
  return {1, -0.5 * (bent + tension) / (2 * bent + tension) / s.quality_factor};
}

CollocatedEquations membrane(const Surface& s, double k, int points, const physics::PistonLift* lift) {
  const auto across = std::make_shared<Across>(points);
  const auto taper = std::make_shared<Taper>(s);
  CollocatedEquations e;
  e.second = Eigen::VectorXd::Ones(points);
  e.mass = Real::Identity(points, points);
  e.inertia = lossy(s, k) * lossy(s, k);
  e.centre = across->centre;
  e.drive = lift ? Eigen::VectorXd::Zero(points) : Eigen::VectorXd((pi / 2 * across->eta.array()).cos());
  e.at = [=](double x, Real& first, Real& here) {
    const Strip strip(*taper, k, across->eta, x);
    first = strip.mixed().asDiagonal() * across->even1;
    here = strip.once().asDiagonal() * across->even1;
    here += strip.twice().asDiagonal() * across->even2;
  };
  if (!lift) return e;
  e.load = [=](double x, Eigen::VectorXd& source, Eigen::VectorXd& value) {
    for (Index j = 0; j < points; ++j) {
      const double y = across->eta[j] * taper->half_width_m(x);
      source[j] = lift->laplacian(x, y) / (k * k);
      value[j] = lift->value(x, y);
    }
  };
  return e;
}

// Returns the shape of a clamped strip at its first cut-off, cos(a eta)/cos a - cosh(b eta)/cosh b.
double shape_at(double eta, double a, double b) {
  const double cosh_ratio = std::exp(b * (eta - 1)) * (1 + std::exp(-2 * b * eta)) / (1 + std::exp(-2 * b));
  return std::cos(a * eta) / std::cos(a) - cosh_ratio;
}

// The equations of a thin plate: u = lap v and lap u - tau u = mu v (v: displacement, lap: Laplacian, tau:
// tension, mu: inertia). On a clamped side lap v = (1 + W'^2)/W^2 d2v/deta2 (W: half-width, eta = y / W).
CollocatedEquations thin_plate(const Surface& s, double k, int points) {
  const auto across = std::make_shared<Across>(points);
  const auto taper = std::make_shared<Taper>(s);
  const double tau = physics::line_tension_N_per_m(s) / *physics::bending_stiffness_N_m(s) / (k * k);
  const Index m = points;
  CollocatedEquations e;
  e.second = Eigen::VectorXd::Ones(2 * m);
  e.mass = Real::Zero(2 * m, 2 * m);
  e.mass.bottomLeftCorner(m, m) = -Real::Identity(m, m);
  e.inertia = lossy(s, k) * lossy(s, k) * (lossy(s, k) * lossy(s, k) + tau);
  e.centre = Eigen::RowVectorXd::Zero(2 * m);
  // v = (1 - eta^2) q, and q is interpolated
  e.centre.head(m) = across->centre.cwiseQuotient((1 - across->eta.array().square()).matrix().transpose());
  e.at = [=](double x, Real& first, Real& here) {
    const Strip strip(*taper, k, across->eta, x);
    const double square = 1 + strip.slope * strip.slope;
    const double side = square / (strip.w * strip.w);
    const double side_slope =
        2 * strip.slope * (strip.curve / strip.w - square / (strip.w * strip.w * strip.w));
    const Eigen::VectorXd mixed = strip.mixed(), once = strip.once(), twice = strip.twice();
    first.setZero(2 * m, 2 * m);
    here.setZero(2 * m, 2 * m);
    first.topLeftCorner(m, m) = mixed.asDiagonal() * across->clamped1;
    first.bottomRightCorner(m, m) = mixed.asDiagonal() * across->even1;
    const Eigen::VectorXd by_side = mixed.cwiseProduct(across->side1);
    first.bottomLeftCorner(m, m) = side * by_side * across->clamped_side;
    here.topLeftCorner(m, m) = once.asDiagonal() * across->clamped1;
    here.topLeftCorner(m, m) += twice.asDiagonal() * across->clamped2;
    here.topRightCorner(m, m) = -Real::Identity(m, m);
    here.bottomRightCorner(m, m) = once.asDiagonal() * across->even1;
    here.bottomRightCorner(m, m) += twice.asDiagonal() * across->even2;
    here.bottomRightCorner(m, m).diagonal().array() -= tau;
    const Eigen::VectorXd from_side = side_slope * by_side + side * once.cwiseProduct(across->side1) +
                                      side * twice.cwiseProduct(across->side2);
    here.bottomLeftCorner(m, m) = from_side * across->clamped_side;
  };
  // The drive edge moves in the shape of the lowest mode across a clamped strip of the same width at its
  // cut-off. The shape follows from a tan a + b tanh b = 0 with b^2 = a^2 + tension.
  const double w0 = k * taper->half_width_m(0), tension = tau * w0 * w0;
  double low = pi / 2, high = pi;
  for (int i = 0; i < 100; ++i) {
    const double a = 0.5 * (low + high), b = std::sqrt(a * a + tension);
    (a * std::sin(a) + b * std::tanh(b) * std::cos(a) > 0 ? low : high) = a;
  }
  const double b = std::sqrt(low * low + tension), unit = shape_at(0, low, b);
  e.drive.resize(m);
  for (Index j = 0; j < m; ++j) e.drive[j] = shape_at(across->eta[j], low, b) / unit;
  const Strip strip(*taper, k, across->eta, 0);  // at the drive edge, the slope at constant y is 0
  e.drive_slope = -strip.along_once().cwiseProduct(across->clamped1 * e.drive);
  return e;
}

// The equations of Mindlin's plate for the displacement w and the rotations beta_x / k and beta_y / k. At the
// drive edge, w and beta_y have the shape of the lowest mode across a strip of the same width at its cut-off,
// and beta_x is 0.
CollocatedEquations mindlin_plate(const Surface& s, double f, double k, int points) {
  const auto across = std::make_shared<Across>(points);
  const auto taper = std::make_shared<Taper>(s);
  const physics::MindlinPlate plate(s);
  const double omega = 2 * pi * f, nu = s.poisson, d = plate.stiffness_N_m * k * k;
  const double less = (1 - nu) / 2, more = (1 + nu) / 2, shear = plate.shear_N_per_m / d;
  const Index m = points;
  CollocatedEquations e;
  e.second = Eigen::VectorXd::Ones(3 * m);
  e.second.tail(m).setConstant(less);
  e.mass = Real::Identity(3 * m, 3 * m) * (plate.rotary_inertia_kg * omega * omega / d);
  e.mass.topLeftCorner(m, m) =
      Real::Identity(m, m) * (plate.mass_kg_per_m2 * omega * omega / (plate.shear_N_per_m * k * k));
  e.inertia = std::pow(lossy(s, k), 4);
  e.centre = Eigen::RowVectorXd::Zero(3 * m);
  e.centre.head(m) = across->centre;
  e.at = [=](double x, Real& first, Real& here) {
    const Strip strip(*taper, k, across->eta, x);
    const Real one = Real::Identity(m, m), even1 = across->even1, odd1 = across->odd1;
    const Eigen::VectorXd along = strip.along_once(), mixed = strip.mixed(), once = strip.once();
    const auto block = [m](Real& all, Index row, Index column) {
      return all.block(row * m, column * m, m, m);
    };
    const double by_y = 1 / strip.w;
    first.setZero(3 * m, 3 * m);
    here.setZero(3 * m, 3 * m);
    // adds the second derivatives of a field with respect to x and y, multiplied by these factors
    const auto add_second = [&](Index i, const Real& d1, const Real& d2, double xx, double yy) {
      block(first, i, i) += xx * (mixed.asDiagonal() * d1);
      block(here, i, i) += xx * (once.asDiagonal() * d1) + xx * (strip.along_twice().asDiagonal() * d2) +
                           yy * by_y * by_y * d2;
    };
    add_second(0, even1, across->even2, 1, 1);
    add_second(1, even1, across->even2, 1, less);
    add_second(2, odd1, across->odd2, less, 1);
    const auto add_mixed = [&](Index i, Index j, const Real& d1, const Real& d2) {  // adds d2/(dx dy)
      block(first, i, j) += more * by_y * d1;
      block(here, i, j) -= more * by_y * strip.r * (d1 + across->eta.asDiagonal() * d2);
    };
    add_mixed(1, 2, odd1, across->odd2);
    add_mixed(2, 1, even1, across->even2);
    block(first, 0, 1) += one;  // the divergence of the rotation beta
    block(here, 0, 1) += along.asDiagonal() * even1;
    block(here, 0, 2) += by_y * odd1;
    block(first, 1, 0) -= shear * one;  // the rotation beta plus the gradient of the displacement w
    block(here, 1, 0) -= shear * (along.asDiagonal() * even1);
    block(here, 2, 0) -= shear * by_y * even1;
    block(here, 1, 1) -= shear * one;
    block(here, 2, 2) -= shear * one;
  };
  const double w0 = taper->half_width_m(0);
  const auto waves = plate.waves(plate.cut_off_frequency_Hz(w0));
  const double a = std::sqrt(waves.bending) * w0, b = std::sqrt(-waves.evanescent) * w0;
  const double unit = shape_at(0, a, b);
  e.drive = Eigen::VectorXd::Zero(3 * m);
  for (Index j = 0; j < m; ++j) {
    const double eta = across->eta[j];
    e.drive[j] = shape_at(eta, a, b) / unit;
    const double sinh_ratio = std::exp(b * (eta - 1)) * (1 - std::exp(-2 * b * eta)) / (1 + std::exp(-2 * b));
    e.drive[2 * m + j] = (waves.share_bending * a * std::sin(a * eta) / std::cos(a) +
                          waves.share_evanescent * b * sinh_ratio) /
                         (unit * w0 * k);
  }
  return e;
}

}  // namespace

Eigen::VectorXd chebyshev_points(int n) {
  Eigen::VectorXd t(n + 1);
  for (int i = 0; i <= n; ++i) t[i] = -std::cos(pi * i / n);
  return t;
}

Eigen::MatrixXd differentiation(const Eigen::VectorXd& t) {
  const Index n = t.size() - 1;
  Real d = Real::Zero(n + 1, n + 1);
  const auto weight = [n](Index i) { return (i == 0 || i == n ? 2.0 : 1.0) * (i % 2 == 0 ? 1 : -1); };
  for (Index i = 0; i <= n; ++i) {
    for (Index j = 0; j <= n; ++j)
      if (i != j) d(i, j) = weight(i) / weight(j) / (t[i] - t[j]);
    d(i, i) = -d.row(i).sum();
  }
  return d;
}

double free_wavenumber_per_m(const Surface& s, double f) {
  if (s.theory == physics::PlateTheory::mindlin) return physics::MindlinPlate(s).wavenumber_per_m(f);
  const double tension = physics::line_tension_N_per_m(s), omega = 2 * pi * f;
  const double mass = s.density_kg_m3 * s.thickness_m * omega * omega;
  const double stiffness = physics::bending_modelled(s) ? *physics::bending_stiffness_N_m(s) : 0;
  return std::sqrt(2 * mass / (tension + std::sqrt(tension * tension + 4 * stiffness * mass)));
}

CollocatedEquations equations_of(const Surface& s, double f, int across, const physics::PistonLift* lift) {
  const double k = free_wavenumber_per_m(s, f);
  const int points = across + static_cast<int>(std::ceil(0.5 * k * physics::half_width_m(s, 0)));
  if (s.theory == physics::PlateTheory::mindlin) return mindlin_plate(s, f, k, points);
  const bool clamped = physics::bending_modelled(s) && s.edges == physics::Edges::clamped;
  return clamped ? thin_plate(s, k, points) : membrane(s, k, points, lift);
}

}  // namespace turnpoint::physics_test

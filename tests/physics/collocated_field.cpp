#include "tests/physics/collocated_field.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/dispersion.hpp"
#include "physics/piston_lift.hpp"
#include "physics/taper.hpp"

namespace turnpoint::physics_test {
namespace {

using physics::PistonLift;
using physics::Surface;
using physics::Taper;
using std::numbers::pi;
using Real = Eigen::MatrixXd;

// Chebyshev points from -1 to 1 and the matrix that differentiates values at them (Trefethen, Spectral
// Methods in MATLAB, program cheb).
Eigen::VectorXd chebyshev_points(int n) {
  Eigen::VectorXd t(n + 1);
  for (int i = 0; i <= n; ++i) t[i] = -std::cos(pi * i / n);
  return t;
}

Real differentiation(const Eigen::VectorXd& t) {
  const Eigen::Index n = t.size() - 1;
  Real d = Real::Zero(n + 1, n + 1);
  const auto weight = [n](Eigen::Index i) { return (i == 0 || i == n ? 2.0 : 1.0) * (i % 2 == 0 ? 1 : -1); };
  for (Eigen::Index i = 0; i <= n; ++i) {
    for (Eigen::Index j = 0; j <= n; ++j)
      if (i != j) d(i, j) = weight(i) / weight(j) / (t[i] - t[j]);
    d(i, i) = -d.row(i).sum();
  }
  return d;
}

// Derivatives of an even function of eta that vanishes at 1, from its values at the points in [0, 1).
struct Across {
  Eigen::VectorXd eta;  // from the centre outward
  Real first, second;

  explicit Across(int points) {
    const Eigen::VectorXd t = chebyshev_points(2 * points);
    const Real d = differentiation(t), d2 = d * d;
    eta = t.segment(points, points);
    eta[0] = 0;
    const auto fold = [points](const Real& full) {
      Real half = full.block(points, points, points, points);
      for (int j = 1; j < points; ++j) half.col(j) += full.col(points - j).segment(points, points);
      return half;
    };
    first = fold(d);
    second = fold(d2);
  }
};

std::vector<std::pair<double, double>> divide(const Surface& surface, const Taper& taper, double k,
                                              const CollocationGrid& grid) {
  std::vector<std::pair<double, double>> list;
  std::vector<double> stops{surface.length_m};
  for (const auto& piece : taper.table().pieces())
    if (piece.x0 > 0 && piece.x0 < surface.length_m) stops.push_back(piece.x0);
  const double w0 = taper.half_width_m(0);
  if (surface.drive == physics::DriveShape::piston && grid.lift * w0 < surface.length_m)
    stops.push_back(grid.lift * w0);
  std::sort(stops.begin(), stops.end());
  double x = 0, decay = 0;
  for (std::size_t i = 0; x < surface.length_m && decay < grid.decay;) {
    const double w = taper.half_width_m(x);
    while (stops[i] <= x * (1 + 1e-12)) ++i;
    double h = std::min(grid.radians / k, w);
    if (list.size() < 2) h = std::min(h, (list.empty() ? 0.12 : 0.4) * w0);
    while (taper.half_width_m(std::min(x + h, stops[i])) < grid.narrowing * w) h *= 0.8;
    const double room = stops[i] - x;
    if (!(room > 1e-9 * w0) || w < 1e-6 * w0) break;
    h = room / std::ceil(room / h * (1 - 1e-12));
    const double middle = pi / (2 * taper.half_width_m(x + 0.5 * h));
    decay += h * std::sqrt(std::max(0.0, middle * middle - k * k));
    list.emplace_back(x, h);
    x = x + 1.001 * h > stops[i] ? stops[i] : x + h;
  }
  return list;
}

template <class Scalar>
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
template <class Scalar>
using Vector = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

// An element's inner values from those at its ends: inner = left v_l + right v_r + source.
template <class Scalar>
struct Slab {
  Matrix<Scalar> left, right;
  Vector<Scalar> source;
  Matrix<Scalar> step;  // v_r = step v_l + offset
  Vector<Scalar> offset;
};

}  // namespace

template <class Scalar>
void CollocatedField::solve(const Surface& surface, Scalar k2, double k, const CollocationGrid& grid) {
  const Taper taper(surface);
  const double w0 = taper.half_width_m(0);
  const int m = grid.across + static_cast<int>(std::ceil(0.5 * k * w0)), n = grid.along, inner = n - 1;
  const Across across(m);
  const Eigen::VectorXd t = chebyshev_points(n);
  const Real d = differentiation(t), d2 = d * d;
  const auto strips = divide(surface, taper, k, grid);
  const bool piston = surface.drive == physics::DriveShape::piston;
  const PistonLift lift(taper, std::min(grid.lift * w0, strips.back().first + strips.back().second));

  std::vector<Slab<Scalar>> slabs(strips.size());
  Matrix<Scalar> slope;  // dv/dx = slope v + slope_source at the left end of what lies farther out
  Vector<Scalar> slope_source;
  for (std::size_t s = strips.size(); s-- > 0;) {
    const auto [x0, h] = strips[s];
    Slab<Scalar>& slab = slabs[s];
    Matrix<Scalar> a = Matrix<Scalar>::Zero(inner * m, inner * m);
    Matrix<Scalar> ends = Matrix<Scalar>::Zero(inner * m, 2 * m + 1);  // left, right, source
    for (int i = 1; i < n; ++i) {
      const double x = x0 + 0.5 * h * (1 + t[i]), w = taper.half_width_m(x), r = taper.slope(x) / w;
      const double stretch = 2 * r * r - taper.second_derivative(x) / w;
      const Eigen::VectorXd& eta = across.eta;
      const Real mixed = -4 * r / h * (eta.asDiagonal() * across.first);
      Real here = stretch * (eta.asDiagonal() * across.first);
      here += (r * r * eta.cwiseAbs2().array() + 1 / (w * w)).matrix().asDiagonal() * across.second;
      for (int other = 0; other <= n; ++other) {
        Real block = d(i, other) * mixed;
        block.diagonal().array() += 4 / (h * h) * d2(i, other);
        if (other == 0) {
          ends.block((i - 1) * m, 0, m, m) = -block;
        } else if (other == n) {
          ends.block((i - 1) * m, m, m, m) = -block;
        } else {
          a.block((i - 1) * m, (other - 1) * m, m, m) = block;
        }
      }
      a.block((i - 1) * m, (i - 1) * m, m, m) += here;
      for (int j = 0; j < m; ++j) {
        a((i - 1) * m + j, (i - 1) * m + j) += k2;
        const double y = eta[j] * w;
        if (piston) ends((i - 1) * m + j, 2 * m) = -(lift.laplacian(x, y) + k2 * lift.value(x, y));
      }
    }
    const Matrix<Scalar> all = a.partialPivLu().solve(ends);
    slab.left = all.leftCols(m);
    slab.right = all.middleCols(m, m);
    slab.source = all.col(2 * m);
    // dv/dx at an end, from the inner values and those at both ends
    const auto derivative = [&](int end, const auto& part) {
      Matrix<Scalar> sum = Matrix<Scalar>::Zero(m, part.cols());
      for (int i = 1; i < n; ++i) sum += 2 / h * d(end, i) * part.middleRows((i - 1) * m, m);
      return sum;
    };
    const Matrix<Scalar> one = Matrix<Scalar>::Identity(m, m);
    slab.step = Matrix<Scalar>::Zero(m, m);
    slab.offset = Vector<Scalar>::Zero(m);
    if (s + 1 < strips.size()) {
      const Matrix<Scalar> lhs = derivative(n, slab.right) + 2 / h * d(n, n) * one - slope;
      const Eigen::PartialPivLU<Matrix<Scalar>> lu(lhs);
      slab.step = -lu.solve(derivative(n, slab.left) + 2 / h * d(n, 0) * one);
      slab.offset = lu.solve(slope_source - derivative(n, slab.source));
    }
    const Matrix<Scalar> by_right = derivative(0, slab.right) + 2 / h * d(0, n) * one;
    slope = derivative(0, slab.left) + 2 / h * d(0, 0) * one + by_right * slab.step;
    slope_source = derivative(0, slab.source) + by_right * slab.offset;
  }

  Vector<Scalar> v = Vector<Scalar>::Zero(m);
  if (!piston) v = (pi / 2 * across.eta.array()).cos().matrix().template cast<Scalar>();
  for (std::size_t s = 0; s < strips.size(); ++s) {
    Element e{strips[s].first, strips[s].second, {}};
    const Vector<Scalar> next = slabs[s].step * v + slabs[s].offset;
    const Vector<Scalar> between = slabs[s].left * v + slabs[s].right * next + slabs[s].source;
    e.centre.push_back(v[0]);
    for (int i = 1; i < n; ++i) e.centre.push_back(between[(i - 1) * m]);
    e.centre.push_back(next[0]);
    v = next;
    elements_.push_back(e);
  }
  if (piston) lift_.emplace(lift);
}

CollocatedField::CollocatedField(const Surface& surface, double f, const CollocationGrid& grid) {
  const double k = physics::wavenumber_per_m(surface, f);
  const std::complex<double> lossy = k * std::complex<double>(1, -0.5 / surface.quality_factor);
  if (std::isfinite(surface.quality_factor)) {
    solve<std::complex<double>>(surface, lossy * lossy, k, grid);
  } else {
    solve<double>(surface, k * k, k, grid);
  }
}

std::complex<double> CollocatedField::value(double x) const {
  auto e = std::partition_point(elements_.begin(), elements_.end(),
                                [x](const Element& one) { return one.x0 + one.h < x; });
  if (e == elements_.end()) return 0;
  const int n = static_cast<int>(e->centre.size()) - 1;
  const double at = 2 * (x - e->x0) / e->h - 1;
  std::complex<double> top = 0;
  double bottom = 0;
  for (int i = 0; i <= n; ++i) {  // barycentric interpolation
    const double gap = at + std::cos(pi * i / n);
    const double weight = (i % 2 == 0 ? 1.0 : -1.0) * (i == 0 || i == n ? 0.5 : 1.0);
    if (std::abs(gap) < 1e-14) {
      top = e->centre[static_cast<std::size_t>(i)];
      bottom = 1;
      break;
    }
    top += weight / gap * e->centre[static_cast<std::size_t>(i)];
    bottom += weight / gap;
  }
  return top / bottom + (lift_ ? lift_->value(x, 0) : 0);
}

}  // namespace turnpoint::physics_test

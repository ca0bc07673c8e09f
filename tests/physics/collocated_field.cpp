#include "tests/physics/collocated_field.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "physics/piston_lift.hpp"
#include "physics/taper.hpp"
#include "tests/physics/collocated_equations.hpp"

namespace turnpoint::physics_test {
namespace {

using physics::Surface;
using physics::Taper;
using std::numbers::pi;
using Real = Eigen::MatrixXd;

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

// The equations of one element of the strip, solved for the inner points. They give the inner values from
// those at its two ends: inner = left u_l + right u_r + source.
template <class Scalar>
struct Slab {
  Matrix<Scalar> left, right;
  Vector<Scalar> source;
  // gives the values at the right end from those at the left end: u_r = step u_l + offset
  Matrix<Scalar> step;
  Vector<Scalar> offset;
};

// Returns the matrix that gives the unknowns at the right end of the last element (the far end of the strip)
// from those at its left end. The first unknowns are held at 0 there. Any others follow from the condition
// that the derivatives of the held unknowns, by_left u_left + by_right u_right, are 0 too.
template <class Scalar>
Matrix<Scalar> at_far_end(const CollocatedEquations& e, const Matrix<Scalar>& by_left,
                          const Matrix<Scalar>& by_right) {
  const Eigen::Index size = e.second.size(), held = e.drive.size(), rest = size - held;
  Matrix<Scalar> step = Matrix<Scalar>::Zero(size, size);
  if (rest > 0)
    step.bottomRows(rest) = -by_right.topRightCorner(held, rest).partialPivLu().solve(by_left.topRows(held));
  return step;
}

}  // namespace

template <class Scalar>
void CollocatedField::solve(const Surface& surface, const CollocatedEquations& e, Scalar inertia, double k,
                            const CollocationGrid& grid) {
  const Taper taper(surface);
  const int n = grid.along, inner = n - 1;
  const Eigen::Index m = e.second.size();
  const Eigen::VectorXd t = chebyshev_points(n);
  const Real d = differentiation(t), d2 = d * d;
  const auto strips = divide(surface, taper, k, grid);
  const Matrix<Scalar> one = Matrix<Scalar>::Identity(m, m);

  std::vector<Slab<Scalar>> slabs(strips.size());
  // gives du/dx at the left end of the strip's part that was solved before (all elements to the right of the
  // current one), from the field there: du/dx = slope u + slope_source
  Matrix<Scalar> slope;
  Vector<Scalar> slope_source;
  Real first, here;
  Eigen::VectorXd source(m), lift(m);
  for (std::size_t s = strips.size(); s-- > 0;) {
    const double x0 = strips[s].first, h = k * strips[s].second;
    Slab<Scalar>& slab = slabs[s];
    Matrix<Scalar> a = Matrix<Scalar>::Zero(inner * m, inner * m);
    // columns: for the left end, for the right end, and for the source
    Matrix<Scalar> ends = Matrix<Scalar>::Zero(inner * m, 2 * m + 1);
    for (int i = 1; i < n; ++i) {
      const double x = x0 + 0.5 * strips[s].second * (1 + t[i]);
      const Eigen::Index row = (i - 1) * m;
      e.at(x, first, here);
      for (int other = 0; other <= n; ++other) {
        Real block = 2 / h * d(i, other) * first;
        block.diagonal() += 4 / (h * h) * d2(i, other) * e.second;
        if (other == 0) {
          ends.block(row, 0, m, m) = -block;
        } else if (other == n) {
          ends.block(row, m, m, m) = -block;
        } else {
          a.block(row, (other - 1) * m, m, m) = block;
        }
      }
      a.block(row, row, m, m) += here + inertia * e.mass;
      if (!e.load) continue;
      e.load(x, source, lift);
      ends.block(row, 2 * m, m, 1) = -(source + inertia * lift);
    }
    const Matrix<Scalar> all = a.partialPivLu().solve(ends);
    slab.left = all.leftCols(m);
    slab.right = all.middleCols(m, m);
    slab.source = all.col(2 * m);
    // returns du/dx at an end, from the inner values and those at both ends
    const auto derivative = [&](int end, const auto& part) {
      Matrix<Scalar> sum = Matrix<Scalar>::Zero(m, part.cols());
      for (int i = 1; i < n; ++i) sum += 2 / h * d(end, i) * part.middleRows((i - 1) * m, m);
      return sum;
    };
    const Matrix<Scalar> by_left = derivative(n, slab.left) + 2 / h * d(n, 0) * one;
    const Matrix<Scalar> by_right = derivative(n, slab.right) + 2 / h * d(n, n) * one;
    slab.offset = Vector<Scalar>::Zero(m);
    if (s + 1 < strips.size()) {
      const Eigen::PartialPivLU<Matrix<Scalar>> lu(by_right - slope);
      slab.step = -lu.solve(by_left);
      slab.offset = lu.solve(slope_source - derivative(n, slab.source));
    } else {
      slab.step = at_far_end(e, by_left, by_right);
    }
    const Matrix<Scalar> from_right = derivative(0, slab.right) + 2 / h * d(0, n) * one;
    slope = derivative(0, slab.left) + 2 / h * d(0, 0) * one + from_right * slab.step;
    slope_source = derivative(0, slab.source) + from_right * slab.offset;
  }

  Vector<Scalar> u = Vector<Scalar>::Zero(m);
  const Eigen::Index held = e.drive.size(), rest = m - held;
  u.head(held) = e.drive.template cast<Scalar>();
  if (rest > 0) {
    const Vector<Scalar> wanted = e.drive_slope - slope.topLeftCorner(held, held) * u.head(held);
    u.tail(rest) = slope.topRightCorner(held, rest).partialPivLu().solve(wanted);
  }
  const auto centre = [&e](const auto& values) { return e.centre.template cast<Scalar>().dot(values); };
  for (std::size_t s = 0; s < strips.size(); ++s) {
    Element element{strips[s].first, strips[s].second, {}};
    const Vector<Scalar> next = slabs[s].step * u + slabs[s].offset;
    const Vector<Scalar> between = slabs[s].left * u + slabs[s].right * next + slabs[s].source;
    element.centre.push_back(centre(u));
    for (int i = 1; i < n; ++i) element.centre.push_back(centre(between.segment((i - 1) * m, m)));
    element.centre.push_back(centre(next));
    u = next;
    elements_.push_back(element);
  }
}

CollocatedField::CollocatedField(const Surface& surface, double f, const CollocationGrid& grid) {
  const double k = free_wavenumber_per_m(surface, f);
  const Taper taper(surface);
  const bool clamped = physics::bending_modelled(surface) && surface.edges == physics::Edges::clamped;
  if (surface.drive == physics::DriveShape::piston) {
    if (clamped)
      throw std::invalid_argument("the jump of a clamped plate's piston is not known in closed form");
    const auto strips = divide(surface, taper, k, grid);
    lift_.emplace(taper,
                  std::min(grid.lift * taper.half_width_m(0), strips.back().first + strips.back().second));
  }
  const auto equations =
      equations_of(surface, f, clamped ? grid.across_plate : grid.across, lift_ ? &*lift_ : nullptr);
  if (std::isfinite(surface.quality_factor)) {
    solve<std::complex<double>>(surface, equations, equations.inertia, k, grid);
  } else {
    solve<double>(surface, equations, equations.inertia.real(), k, grid);
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
  for (int i = 0; i <= n; ++i) {  // barycentric interpolation between the points
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

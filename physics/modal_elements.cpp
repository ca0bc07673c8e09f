#include "physics/modal_elements.hpp"

#include <algorithm>
#include <cmath>

#include "physics/operations.hpp"

namespace turnpoint::physics {
namespace {

// A matrix type with a fixed maximum size, so that its storage is on the stack.
using Small =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, largest_degree + 4, largest_degree + 4>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, largest_degree + 4, 1>;

}  // namespace

double take_out_size(Eigen::VectorXcd& unknowns) {
  const double size = unknowns.cwiseAbs().maxCoeff();
  if (!(size > 0)) return 0;
  unknowns /= size;
  return std::log(size);
}

ModalAssembler::ModalAssembler(const Taper& taper, const TransverseBasis& across, const ElementBasis& along,
                               const ModalEquation& equation, double slope_unit_m)
    : taper_(taper),
      across_(across),
      along_(along),
      equation_(equation),
      slope_unit_m_(slope_unit_m),
      rule_(gauss_legendre(along.degree + 3)) {
  for (const double t : rule_.x) table_.push_back(along.at(2 * t - 1));
  for (std::size_t m = 0; m < 4; ++m) {
    for (std::size_t l = 0; l < 4; ++l) {
      single_bend_(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(l)) = across.bend[m][l](0, 0);
    }
  }
}

std::vector<ModalAssembler::Point> ModalAssembler::points(const ModalElement& e) const {
  std::vector<Point> list;
  list.reserve(rule_.x.size());
  const double d = 2 / e.h;
  for (std::size_t q = 0; q < rule_.x.size(); ++q) {
    const double x = e.x0 + e.h * rule_.x[q];
    Point point{e.h * rule_.w[q], taper_.half_width_m(x), taper_.slope(x), taper_.second_derivative(x),
                table_[q]};
    for (int a = 0; a < along_.count(); ++a) {
      const bool slope = along_.per_vertex == 2 && (a == 1 || a == along_.count() - 1);
      const double factor = slope ? slope_factor(e) : 1;
      const auto i = static_cast<std::size_t>(a);
      point.basis.value[i] *= factor;
      point.basis.first[i] *= factor * d;
      point.basis.second[i] *= factor * d * d;
    }
    list.push_back(point);
  }
  return list;
}

// The field is v = X(x) Y(eta). With r = W'/W, lap v = Y X'' + eta Y' [(2 r^2 - W''/W) X - 2 r X'] + eta^2
// Y'' r^2 X + Y'' X / W^2. This function returns the bending term (lap v)^2 and the tension term as a
// quadratic form in X'', X' and X. It uses the integrals over eta of all products of Y, eta Y', eta^2 Y'' and
// Y''.
ModalAssembler::Form ModalAssembler::single_form(double w, double r, double curve) const {
  const double across = 1 / (w * w), stretch = 2 * r * r - curve;
  const auto& m = single_bend_;
  const double bending = equation_.bending, tension = equation_.tension;
  // the terms of the Laplacian of v that contain X itself, not its derivatives
  const auto with_value = [&](Eigen::Index row) {
    return stretch * m(row, 1) + r * r * m(row, 2) + across * m(row, 3);
  };
  Form f;
  f.ss = bending * m(0, 0);
  f.sf = bending * -2 * r * m(0, 1);
  f.sv = bending * with_value(0);
  f.ff = bending * 4 * r * r * m(1, 1) + tension * across_.mass(0, 0);
  f.fv = bending * -2 * r * with_value(1) - tension * r * across_.stretch(0, 0);
  f.vv = bending * (stretch * with_value(1) + r * r * with_value(2) + across * with_value(3)) +
         tension * (r * r * across_.shear(0, 0) + across_.stiff(0, 0) * across);
  return f;
}

// With a single transverse function, the weak form at a point is a quadratic form in X'', X' and X. Plain
// loops over these few numbers are fast. Speed matters: the model `mode` of a clamped plate spends most of
// its time here.
Eigen::MatrixXcd ModalAssembler::single_matrix(const ModalElement& e) const {
  using Rows = std::array<double, largest_degree + 1>;
  const auto n = static_cast<std::size_t>(along_.count());
  const double d = 2 / e.h, mass_across = across_.mass(0, 0);
  std::array<Rows, largest_degree + 1> stiffness{}, mass{};
  count_operations(static_cast<double>(rule_.x.size() * n * (4 * (n + 1) + 25)));
  for (std::size_t q = 0; q < rule_.x.size(); ++q) {
    const double x = e.x0 + e.h * rule_.x[q], w = taper_.half_width_m(x);
    const Form f = single_form(w, taper_.slope(x) / w, taper_.second_derivative(x) / w);
    const double weight = e.h * rule_.w[q] * w;
    const BasisValues& basis = table_[q];
    Rows s{}, p{}, v{}, fs{}, fp{}, fv{};
    for (std::size_t a = 0; a < n; ++a) {
      const bool slope = along_.per_vertex == 2 && (a == 1 || a == n - 1);
      const double factor = slope ? slope_factor(e) : 1;
      s[a] = factor * d * d * basis.second[a];
      p[a] = factor * d * basis.first[a];
      v[a] = factor * basis.value[a];
    }
    for (std::size_t a = 0; a < n; ++a) {
      fs[a] = weight * (f.ss * s[a] + f.sf * p[a] + f.sv * v[a]);
      fp[a] = weight * (f.sf * s[a] + f.ff * p[a] + f.fv * v[a]);
      fv[a] = weight * (f.sv * s[a] + f.fv * p[a] + f.vv * v[a]);
    }
    for (std::size_t a = 0; a < n; ++a) {
      const double va = weight * mass_across * v[a];
      for (std::size_t b = 0; b <= a; ++b) {
        stiffness[a][b] += fs[a] * s[b] + fp[a] * p[b] + fv[a] * v[b];
        mass[a][b] += va * v[b];
      }
    }
  }
  const auto size =
      static_cast<Eigen::Index>(e.right == 0 ? n - static_cast<std::size_t>(along_.per_vertex) : n);
  Eigen::MatrixXcd k(size, size);
  for (Eigen::Index a = 0; a < size; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) {
      const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
      k(a, b) = k(b, a) = stiffness[i][j] - equation_.inertia * mass[i][j];
    }
  }
  return k;
}

Eigen::MatrixXcd ModalAssembler::matrix(const ModalElement& e) const {
  if (across_.count() == 1) return single_matrix(e);
  const int n = along_.count();
  const std::vector<Point> list = points(e);
  const auto rows = static_cast<Eigen::Index>(list.size());
  // Values of the basis functions at the quadrature points, one row per point, and the weights of the
  // quadrature.
  Small value(rows, n), first(rows, n), second(rows, n);
  Column weight(rows), w(rows), w1(rows), curve(rows);
  for (Eigen::Index q = 0; q < rows; ++q) {
    const Point& p = list[static_cast<std::size_t>(q)];
    for (int a = 0; a < n; ++a) {
      const auto i = static_cast<std::size_t>(a);
      value(q, a) = p.basis.value[i];
      first(q, a) = p.basis.first[i];
      second(q, a) = p.basis.second[i];
    }
    weight[q] = p.weight;
    w[q] = p.w;
    w1[q] = p.w1;
    curve[q] = p.w2 / p.w;
  }
  const Column r = w1.cwiseQuotient(w);
  const auto gram = [](const Small& a, const Column& by, const Small& b) -> Small {
    return a.transpose().lazyProduct(by.asDiagonal() * b);
  };
  const Small slope = gram(first, weight.cwiseProduct(w), first);
  const Small cross = gram(first, weight.cwiseProduct(w1), value);
  const Small shear = gram(value, weight.cwiseProduct(w1).cwiseProduct(r), value);
  const Small stiff = gram(value, weight.cwiseQuotient(w), value);
  const Small mass = gram(value, weight.cwiseProduct(w), value);
  std::array<std::array<Small, 4>, 4> bend;
  if (equation_.plate()) {
    // Terms of lap v for v = X(x) Y(eta): lap v = X'' Y + [(2 r^2 - W''/W) X - 2 r X'] eta Y' + r^2 X eta^2
    // Y'' + X Y''/W^2, with r = W'/W.
    const Column r2 = r.cwiseProduct(r);
    const Column stretch = 2 * r2 - curve;
    const Column across = w.cwiseProduct(w).cwiseInverse();
    std::array<Small, 4> part{second, second, second, second};
    part[1] = stretch.asDiagonal() * value;
    part[1] -= 2 * (r.asDiagonal() * first);
    part[2] = r2.asDiagonal() * value;
    part[3] = across.asDiagonal() * value;
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) bend[i][j] = gram(part[i], weight.cwiseProduct(w), part[j]);
    }
  }
  // The unknowns that exist, each as a pair of indices: function along x, transverse function. The right
  // vertex may have fewer transverse functions than the left.
  std::vector<std::pair<int, int>> index;
  for (int a = 0; a < n; ++a) {
    const int functions = a >= n - along_.per_vertex ? e.right : e.left;
    for (int i = 0; i < functions; ++i) index.emplace_back(a, i);
  }
  const auto size = static_cast<Eigen::Index>(index.size());
  // products over the quadrature points, and the terms that each pair of unknowns sums
  const double products = equation_.plate() ? 5 + 16 : 5, terms = equation_.plate() ? 14 + 48 : 14;
  count_operations(2 * products * static_cast<double>(rows * n * n) +
                   0.5 * terms * static_cast<double>(size * (size + 1)));
  Eigen::MatrixXcd k(size, size);
  for (Eigen::Index row = 0; row < size; ++row) {
    const auto [a, i] = index[static_cast<std::size_t>(row)];
    for (Eigen::Index column = 0; column <= row; ++column) {
      const auto [b, j] = index[static_cast<std::size_t>(column)];
      double real =
          equation_.tension * (slope(a, b) * across_.mass(i, j) - cross(a, b) * across_.stretch(i, j) -
                               cross(b, a) * across_.stretch(j, i) + shear(a, b) * across_.shear(i, j) +
                               stiff(a, b) * across_.stiff(i, j));
      if (equation_.plate()) {
        for (std::size_t m = 0; m < 4; ++m) {
          for (std::size_t l = 0; l < 4; ++l) {
            real += equation_.bending * bend[m][l](a, b) * across_.bend[m][l](i, j);
          }
        }
      }
      k(row, column) = real - equation_.inertia * (mass(a, b) * across_.mass(i, j));
      k(column, row) = k(row, column);
    }
  }
  return k;
}

}  // namespace turnpoint::physics

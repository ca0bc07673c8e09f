#include "physics/modal_elements.hpp"

#include <algorithm>

namespace turnpoint::physics {
namespace {

// No larger than an element's basis or quadrature, so that they live on the stack.
using Small =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, largest_degree + 4, largest_degree + 4>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, largest_degree + 4, 1>;

// Second derivative of the half-width; a table's jumps at its knots, where elements end.
double second_derivative(const Taper& taper, double x) {
  if (const auto* t = std::get_if<ExponentialTaper>(&taper.form())) {
    return taper.half_width_m(x) / (t->decay_length_m * t->decay_length_m);
  }
  if (std::holds_alternative<TabulatedTaper>(taper.form())) {
    const Cubic& p = taper.table().piece(x);
    return 2 * p.c2 + 6 * p.c3 * (x - p.x0);
  }
  return 0;
}

}  // namespace

ModalAssembler::ModalAssembler(const Taper& taper, const TransverseBasis& across, const ElementBasis& along,
                               const ModalEquation& equation, double slope_unit_m)
    : taper_(taper),
      across_(across),
      along_(along),
      equation_(equation),
      slope_unit_m_(slope_unit_m),
      rule_(gauss_legendre(along.degree + 3)) {
  for (const double t : rule_.x) table_.push_back(along.at(2 * t - 1));
}

std::vector<ModalAssembler::Point> ModalAssembler::points(const ModalElement& e) const {
  std::vector<Point> list;
  list.reserve(rule_.x.size());
  const double d = 2 / e.h;
  for (std::size_t q = 0; q < rule_.x.size(); ++q) {
    const double x = e.x0 + e.h * rule_.x[q];
    Point point{e.h * rule_.w[q], taper_.half_width_m(x), taper_.slope(x), second_derivative(taper_, x),
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

Eigen::MatrixXcd ModalAssembler::matrix(const ModalElement& e) const {
  const int n = along_.count();
  const std::vector<Point> list = points(e);
  const auto rows = static_cast<Eigen::Index>(list.size());
  // Basis functions at the quadrature points, one row a point, and the mapping's weights there.
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
    // lap v = X'' Y + [(2 r^2 - W''/W) X - 2 r X'] eta Y' + r^2 X eta^2 Y'' + X Y''/W^2
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
  // Which unknowns exist: fewer transverse functions at the right vertex.
  std::vector<std::pair<int, int>> index;
  for (int a = 0; a < n; ++a) {
    const int functions = a >= n - along_.per_vertex ? e.right : e.left;
    for (int i = 0; i < functions; ++i) index.emplace_back(a, i);
  }
  const auto size = static_cast<Eigen::Index>(index.size());
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

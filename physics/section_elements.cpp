#include "physics/section_elements.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "physics/element_basis.hpp"
#include "physics/transverse_basis.hpp"

namespace turnpoint::physics {
namespace {

using Eigen::MatrixXd;
constexpr int degree_across = 5, degree_through = 11;

// Integrals of a set of functions of one coordinate: U V, U V', U' V'.
struct Line {
  MatrixXd mass, cross, stiff;
};

// Continuous elements on [0, 1] that vanish at 1, and at 0 where `odd`.
Line across_line(const std::vector<double>& ends, bool odd) {
  const ElementBasis basis{degree_across, 1};
  const auto elements = static_cast<Eigen::Index>(ends.size()) - 1;
  const Eigen::Index size = elements * degree_across + 1;
  Line all{MatrixXd::Zero(size, size), MatrixXd::Zero(size, size), MatrixXd::Zero(size, size)};
  const Quadrature rule = gauss_legendre(degree_across + 2);
  for (Eigen::Index e = 0; e < elements; ++e) {
    const auto i = static_cast<std::size_t>(e);
    const double h = ends[i + 1] - ends[i];
    for (std::size_t q = 0; q < rule.x.size(); ++q) {
      const BasisValues at = basis.at(2 * rule.x[q] - 1);
      for (Eigen::Index a = 0; a <= degree_across; ++a) {
        for (Eigen::Index b = 0; b <= degree_across; ++b) {
          const double va = at.value[static_cast<std::size_t>(a)], vb = at.value[static_cast<std::size_t>(b)];
          const double da = at.first[static_cast<std::size_t>(a)] * 2 / h;
          const double db = at.first[static_cast<std::size_t>(b)] * 2 / h;
          const Eigen::Index row = e * degree_across + a, column = e * degree_across + b;
          all.mass(row, column) += rule.w[q] * h * va * vb;
          all.cross(row, column) += rule.w[q] * h * va * db;
          all.stiff(row, column) += rule.w[q] * h * da * db;
        }
      }
    }
  }
  const Eigen::Index first = odd ? 1 : 0, kept = size - 1 - first;
  for (MatrixXd* one : {&all.mass, &all.cross, &all.stiff})
    *one = MatrixXd(one->block(first, first, kept, kept));
  return all;
}

// Rows of cross-integrals between the even functions (A, c) and the odd ones (b) of y: all functions, and the
// odd set leaves out the first.
MatrixXd without_first_column(const MatrixXd& m) { return m.rightCols(m.cols() - 1); }

// Legendre polynomials of 2z/h on [0, h/2], odd or even; U' with respect to z.
struct Through {
  MatrixXd odd_mass, odd_stiff, even_mass, even_stiff;
  MatrixXd odd_even, odd_even_slope, odd_slope_even;  // U_odd U_even, U_odd U_even', U_odd' U_even
};

Through through_thickness(double thickness) {
  constexpr Eigen::Index n = (degree_through + 1) / 2;
  const Quadrature rule = gauss_legendre(degree_through + 2);
  const auto points = static_cast<Eigen::Index>(rule.x.size());
  MatrixXd odd(n, points), even(n, points), odd1(n, points), even1(n, points);
  Eigen::VectorXd weight(points);
  for (Eigen::Index q = 0; q < points; ++q) {
    const double t = rule.x[static_cast<std::size_t>(q)];
    weight[q] = rule.w[static_cast<std::size_t>(q)] * thickness / 2;
    double p0 = 1, p1 = t, d0 = 0, d1 = 1;
    for (Eigen::Index k = 0; k <= degree_through; ++k) {
      (k % 2 ? odd : even)(k / 2, q) = p0;
      (k % 2 ? odd1 : even1)(k / 2, q) = d0 * 2 / thickness;
      const double m = static_cast<double>(k) + 2;
      const double p2 = ((2 * m - 1) * t * p1 - (m - 1) * p0) / m;
      const double d2 = ((2 * m - 1) * (p1 + t * d1) - (m - 1) * d0) / m;
      p0 = p1, p1 = p2, d0 = d1, d1 = d2;
    }
  }
  const auto gram = [&](const MatrixXd& a, const MatrixXd& b) -> MatrixXd {
    return a * weight.asDiagonal() * b.transpose();
  };
  return {gram(odd, odd),  gram(odd1, odd1), gram(even, even), gram(even1, even1),
          gram(odd, even), gram(odd, even1), gram(odd1, even)};
}

MatrixXd tensor(const MatrixXd& across, const MatrixXd& through) {
  MatrixXd all(across.rows() * through.rows(), across.cols() * through.cols());
  for (Eigen::Index i = 0; i < across.rows(); ++i) {
    for (Eigen::Index j = 0; j < across.cols(); ++j)
      all.block(i * through.rows(), j * through.cols(), through.rows(), through.cols()) =
          across(i, j) * through;
  }
  return all;
}

// Element ends: the layer along the clamp is as deep as the plate is thick.
std::vector<double> element_ends(double thickness) {
  const double layer = std::min(0.5, 1.2 * thickness);
  std::vector<double> ends{0, 0.5 * (1 - layer), 1 - layer};
  for (const double part : {0.4, 0.15, 0.05, 0.015}) ends.push_back(1 - part * layer);
  ends.push_back(1);
  return ends;
}

}  // namespace

SectionElements::SectionElements(double thickness, double nu) : lame(2 * nu / (1 - 2 * nu)) {
  const std::vector<double> ends = element_ends(thickness);
  const Line even = across_line(ends, false), odd = across_line(ends, true);
  const Through z = through_thickness(thickness);
  along_mass = tensor(even.mass, z.odd_mass);
  shear = tensor(even.stiff, z.odd_mass) + tensor(even.mass, z.odd_stiff);
  const MatrixXd b_mass = tensor(odd.mass, z.odd_mass), c_mass = tensor(even.mass, z.even_mass);
  const Eigen::Index nb = b_mass.rows(), nc = c_mass.rows();
  mass = MatrixXd::Zero(nb + nc, nb + nc);
  mass.topLeftCorner(nb, nb) = b_mass;
  mass.bottomRightCorner(nc, nc) = c_mass;
  plane = MatrixXd::Zero(nb + nc, nb + nc);
  plane.topLeftCorner(nb, nb) = (lame + 2) * tensor(odd.stiff, z.odd_mass) + tensor(odd.mass, z.odd_stiff);
  plane.bottomRightCorner(nc, nc) =
      (lame + 2) * tensor(even.mass, z.even_stiff) + tensor(even.stiff, z.even_mass);
  // lame (b_y, c_z) + (b_z, c_y); rows b, without the even functions' first in y.
  const MatrixXd slope_value = even.cross.transpose().bottomRows(odd.mass.rows());
  const MatrixXd value_slope = even.cross.bottomRows(odd.mass.rows());
  const MatrixXd bc = lame * tensor(slope_value, z.odd_even_slope) + tensor(value_slope, z.odd_slope_even);
  plane.topRightCorner(nb, nc) = bc;
  plane.bottomLeftCorner(nc, nb) = bc.transpose();
  // lame (A, b_y + c_z) - (A_y, b) - (A_z, c)
  coupling.resize(along_mass.rows(), nb + nc);
  coupling.leftCols(nb) =
      tensor(MatrixXd(without_first_column(lame * even.cross - even.cross.transpose())), z.odd_mass);
  coupling.rightCols(nc) = tensor(even.mass, MatrixXd(lame * z.odd_even_slope - z.odd_slope_even));
}

SectionCutOff section_cut_off(const SectionElements& section) {
  const Eigen::LLT<MatrixXd> solver(section.plane);
  Eigen::VectorXd x = Eigen::VectorXd::Zero(section.plane.rows());
  x.tail(section.along_mass.rows()).setOnes();
  double omega2 = 0;
  for (int i = 0; i < 60; ++i) {
    x /= std::sqrt(x.dot(section.mass * x));
    const Eigen::VectorXd next = solver.solve(section.mass * x);
    const double now = 1 / x.dot(section.mass * next);
    x = next;
    const bool settled = std::abs(now - omega2) <= 1e-14 * now;
    omega2 = now;
    if (settled && i > 8) break;
  }
  return {std::sqrt(omega2), x};
}

}  // namespace turnpoint::physics

#include "physics/section_elements.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/element_basis.hpp"
#include "physics/operations.hpp"
#include "physics/transverse_basis.hpp"

namespace turnpoint::physics {
namespace {

using Eigen::MatrixXd;
constexpr Eigen::Index degree_across = 5, degree_through = 11;

// Returns the ends of the elements in y. In a layer along the clamp the elements are finer.
std::vector<double> element_ends(double layer) {
  std::vector<double> ends{0, 0.5 * (1 - layer), 1 - layer};
  for (const double part : {0.4, 0.15, 0.05, 0.015}) ends.push_back(1 - part * layer);
  ends.push_back(1);
  return ends;
}

// Returns continuous, piecewise polynomial functions on [0, 1] that vanish at 1. The odd functions vanish at
// 0 as well.
LineFunctions across_functions(double layer) {
  const std::vector<double> ends = element_ends(layer);
  const ElementBasis basis{degree_across, 1};
  const Quadrature rule = gauss_legendre(degree_across + 2);
  const auto elements = static_cast<Eigen::Index>(ends.size()) - 1;
  const auto nodes = static_cast<Eigen::Index>(rule.x.size());
  const Eigen::Index size = elements * degree_across;
  LineFunctions f;
  MatrixXd value = MatrixXd::Zero(size + 1, elements * nodes), slope = value;
  f.at.resize(elements * nodes);
  f.weight.resize(elements * nodes);
  for (Eigen::Index e = 0; e < elements; ++e) {
    const double start = ends[static_cast<std::size_t>(e)], h = ends[static_cast<std::size_t>(e) + 1] - start;
    for (Eigen::Index q = 0; q < nodes; ++q) {
      const auto i = static_cast<std::size_t>(q);
      const BasisValues one = basis.at(2 * rule.x[i] - 1);
      f.at[e * nodes + q] = start + h * rule.x[i];
      f.weight[e * nodes + q] = h * rule.w[i];
      for (Eigen::Index a = 0; a <= degree_across; ++a) {
        value(e * degree_across + a, e * nodes + q) = one.value[static_cast<std::size_t>(a)];
        slope(e * degree_across + a, e * nodes + q) = one.first[static_cast<std::size_t>(a)] * 2 / h;
      }
    }
  }
  f.even = value.topRows(size);
  f.even_slope = slope.topRows(size);
  f.odd = value.middleRows(1, size - 1);
  f.odd_slope = slope.middleRows(1, size - 1);
  f.even_start = Eigen::VectorXd::Unit(size, 0);
  return f;
}

// Returns Legendre polynomials of 2z/h on [0, h/2], even and odd ones separately.
LineFunctions through_functions(double thickness) {
  constexpr Eigen::Index n = (degree_through + 1) / 2;
  const Quadrature rule = gauss_legendre(degree_through + 2);
  const auto points = static_cast<Eigen::Index>(rule.x.size());
  LineFunctions f;
  for (MatrixXd* one : {&f.even, &f.even_slope, &f.odd, &f.odd_slope}) one->resize(n, points);
  f.at.resize(points);
  f.weight.resize(points);
  f.even_start.resize(n);
  for (Eigen::Index q = 0; q <= points; ++q) {  // the last point is z = 0
    const auto i = static_cast<std::size_t>(q);
    const double t = q < points ? rule.x[i] : 0;
    if (q < points) {
      f.at[q] = t * thickness / 2;
      f.weight[q] = rule.w[i] * thickness / 2;
    }
    double p0 = 1, p1 = t, d0 = 0, d1 = 1;
    for (Eigen::Index k = 0; k <= degree_through; ++k) {
      if (q == points) {
        if (k % 2 == 0) f.even_start[k / 2] = p0;
      } else {
        (k % 2 ? f.odd : f.even)(k / 2, q) = p0;
        (k % 2 ? f.odd_slope : f.even_slope)(k / 2, q) = d0 * 2 / thickness;
      }
      const double m = static_cast<double>(k) + 2;
      const double p2 = ((2 * m - 1) * t * p1 - (m - 1) * p0) / m;
      const double d2 = ((2 * m - 1) * (p1 + t * d1) - (m - 1) * d0) / m;
      p0 = p1, p1 = p2, d0 = d1, d1 = d2;
    }
  }
  return f;
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

}  // namespace

// The layer of finer elements along the clamp is 1.2 times as wide as the plate is thick, but at most half of
// the half-width.
SectionElements::SectionElements(double thickness, double nu)
    : SectionElements(thickness, nu, std::min(0.5, 1.2 * thickness)) {}

SectionElements::SectionElements(double thickness, double nu, double layer)
    : across(across_functions(layer)), through(through_functions(thickness)), lame(2 * nu / (1 - 2 * nu)) {
  const auto y = [this](const MatrixXd& a, const MatrixXd& b) -> MatrixXd {
    return a * across.weight.asDiagonal() * b.transpose();
  };
  const auto z = [this](const MatrixXd& a, const MatrixXd& b) -> MatrixXd {
    return a * through.weight.asDiagonal() * b.transpose();
  };
  const LineFunctions& c = across;
  const LineFunctions& t = through;
  const MatrixXd odd_z = z(t.odd, t.odd), even_z = z(t.even, t.even);
  const MatrixXd even_y = y(c.even, c.even);
  SectionPencil& p = pencil;
  p.along_mass = tensor(even_y, odd_z);
  p.along = (lame + 2) * p.along_mass;
  p.shear = tensor(y(c.even_slope, c.even_slope), odd_z) + tensor(even_y, z(t.odd_slope, t.odd_slope));
  const MatrixXd b_mass = tensor(y(c.odd, c.odd), odd_z), c_mass = tensor(even_y, even_z);
  const Eigen::Index nb = b_mass.rows(), nc = c_mass.rows();
  p.mass = MatrixXd::Zero(nb + nc, nb + nc);
  p.mass.topLeftCorner(nb, nb) = b_mass;
  p.mass.bottomRightCorner(nc, nc) = c_mass;
  p.cross = p.mass;
  p.plane.resize(nb + nc, nb + nc);
  p.plane.topLeftCorner(nb, nb) = (lame + 2) * tensor(y(c.odd_slope, c.odd_slope), odd_z) +
                                  tensor(y(c.odd, c.odd), z(t.odd_slope, t.odd_slope));
  p.plane.bottomRightCorner(nc, nc) = (lame + 2) * tensor(even_y, z(t.even_slope, t.even_slope)) +
                                      tensor(y(c.even_slope, c.even_slope), even_z);
  // integrals of lame (b_y, c_z) + (b_z, c_y), with b_y = db/dy; see SectionElements for A, b and c
  p.plane.topRightCorner(nb, nc) = lame * tensor(y(c.odd_slope, c.even), z(t.odd, t.even_slope)) +
                                   tensor(y(c.odd, c.even_slope), z(t.odd_slope, t.even));
  p.plane.bottomLeftCorner(nc, nb) = p.plane.topRightCorner(nb, nc).transpose();
  // integrals of lame (A, b_y + c_z) - (A_y, b) - (A_z, c)
  p.coupling.resize(p.along_mass.rows(), nb + nc);
  p.coupling.leftCols(nb) = tensor(lame * y(c.even, c.odd_slope) - y(c.even_slope, c.odd), odd_z);
  p.coupling.rightCols(nc) = tensor(even_y, lame * z(t.odd, t.even_slope) - z(t.odd_slope, t.even));
  // integrals of (A_y, eta b_eta) + (A_z, eta c_eta)
  p.stretching.resize(p.along_mass.rows(), nb + nc);
  const auto stretched = [&c](const MatrixXd& slope) -> MatrixXd { return slope * c.at.asDiagonal(); };
  p.stretching.leftCols(nb) = tensor(y(c.even_slope, stretched(c.odd_slope)), odd_z);
  p.stretching.rightCols(nc) = tensor(y(c.even, stretched(c.even_slope)), z(t.odd_slope, t.even));
}

Eigen::VectorXd SectionElements::thickening(const Eigen::VectorXd& along) const {
  // Leave out b, and the first function of z in c: it is the mean of c over the thickness, so it describes
  // deflection and not thickening.
  const Eigen::Index nb = across.odd.rows() * through.odd.rows(), nz = through.even.rows();
  const MatrixXd load =
      lame * tensor(across.even * across.weight.asDiagonal() * across.even.transpose(),
                    through.even_slope * through.weight.asDiagonal() * through.odd.transpose());
  const Eigen::VectorXd force = -load * along;
  std::vector<Eigen::Index> kept;
  for (Eigen::Index i = 0; i < force.size(); ++i) {
    if (i % nz != 0) kept.push_back(i);
  }
  const MatrixXd stiffness = pencil.plane.bottomRightCorner(force.size(), force.size());
  const Eigen::VectorXd c = MatrixXd(stiffness(kept, kept)).llt().solve(Eigen::VectorXd(force(kept)));
  Eigen::VectorXd all = Eigen::VectorXd::Zero(nb + force.size());
  for (std::size_t i = 0; i < kept.size(); ++i) all[nb + kept[i]] = c[static_cast<Eigen::Index>(i)];
  return all;
}

SectionCutOff section_cut_off(const SectionPencil& pencil) {
  const auto n = static_cast<double>(pencil.plane.rows());
  count_operations(n * n * n / 3);
  const Eigen::LLT<MatrixXd> solver(pencil.plane);
  Eigen::VectorXd x = Eigen::VectorXd::Ones(pencil.plane.rows());
  double omega2 = 0;
  for (int i = 0; i < 60; ++i) {
    count_operations(6 * n * n);
    x /= std::sqrt(x.dot(pencil.mass * x));
    const Eigen::VectorXd next = solver.solve(pencil.mass * x);
    const double now = 1 / x.dot(pencil.mass * next);
    x = next;
    const bool settled = std::abs(now - omega2) <= 1e-14 * now;
    omega2 = now;
    if (settled && i > 8) break;
  }
  return {std::sqrt(omega2), x / std::sqrt(x.dot(pencil.mass * x))};
}

SectionShapes section_shapes_of(const SectionPencil& p) {
  const SectionCutOff at = section_cut_off(p);
  const auto n = static_cast<double>(p.shear.rows());
  count_operations(2 * n * n * n / 3);
  const Eigen::PartialPivLU<MatrixXd> along(p.shear - at.omega * at.omega * p.along_mass);
  return {at.shape, along.solve(-p.coupling * at.shape), along.solve(-p.stretching * at.shape)};
}

SectionShapes section_shapes_of(const SectionPencil& p, double omega, double along2) {
  const double o2 = omega * omega;
  const auto na = static_cast<double>(p.shear.rows()), nb = static_cast<double>(p.plane.rows());
  count_operations(na * na * na / 3 + 2 * na * nb * (na + nb) + 2 * nb * nb * nb / 3);
  const Eigen::LDLT<MatrixXd> along(p.shear + along2 * p.along - o2 * p.along_mass);
  // the matrix that remains for B after A is eliminated
  const Eigen::PartialPivLU<MatrixXd> cross(p.plane + along2 * p.cross - o2 * p.mass -
                                            along2 * p.coupling.transpose() * along.solve(p.coupling));
  Eigen::VectorXd x = section_cut_off(p).shape;
  for (int i = 0; i < 4; ++i) {
    x = cross.solve(p.mass * x);
    x /= std::sqrt(x.dot(p.mass * x));
  }
  return {x, along.solve(-p.coupling * x), along.solve(-p.stretching * x)};
}

}  // namespace turnpoint::physics

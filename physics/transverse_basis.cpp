#include "physics/transverse_basis.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/operations.hpp"

namespace turnpoint::physics {

namespace {

Quadrature make_gauss_legendre(int n) {
  Quadrature rule;
  rule.x.resize(static_cast<std::size_t>(n));
  rule.w.resize(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) {
    double t = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1;
    for (int step = 0; step < 20; ++step) {
      double p0 = 1, p1 = t;
      for (int k = 2; k <= n; ++k) {
        const double p2 = ((2 * k - 1) * t * p1 - (k - 1) * p0) / k;
        p0 = p1;
        p1 = p2;
      }
      slope = n * (t * p1 - p0) / (t * t - 1);
      const double by = p1 / slope;
      t -= by;
      if (std::abs(by) < 1e-16) break;
    }
    const auto j = static_cast<std::size_t>(n - 1 - i);
    rule.x[j] = 0.5 * (1 + t);
    rule.w[j] = 1 / ((1 - t * t) * slope * slope);
  }
  return rule;
}

}  // namespace

Quadrature gauss_legendre(int n) {
  // Rules with up to `kept` nodes are made only once. Making a rule takes almost as long as evaluating a
  // solution at 1000 points.
  constexpr int kept = 40;
  static const std::vector<Quadrature> rules = [] {
    std::vector<Quadrature> list;
    for (int i = 0; i <= kept; ++i) list.push_back(make_gauss_legendre(std::max(1, i)));
    return list;
  }();
  return n >= 1 && n <= kept ? rules[static_cast<std::size_t>(n)] : make_gauss_legendre(n);
}

void add_bubbles(Eigen::VectorXd& sum, int power, Parity parity, double eta, double times) {
  const double u = 1 - eta * eta, bubble = times * (power == 1 ? u : u * u);
  const int last = 2 * static_cast<int>(sum.size());
  double p0 = 1, p1 = eta;
  for (int k = 0; k < last; ++k) {
    if (k % 2 == (parity == Parity::odd)) sum[k / 2] += std::sqrt(2 * k + 1.0) * bubble * p0;
    const double p2 = ((2 * k + 3) * eta * p1 - (k + 1) * p0) / (k + 2);
    p0 = p1, p1 = p2;
  }
}

TransverseBasis TransverseBasis::polynomials(int count, int power, Parity parity) {
  TransverseBasis basis;
  basis.rule_ = gauss_legendre(count + 10 + 2 * power);
  const auto nodes = static_cast<Eigen::Index>(basis.rule_.x.size());
  basis.value_.resize(count, nodes);
  basis.first_.resize(count, nodes);
  basis.second_.resize(count, nodes);
  basis.centre.resize(count);
  // The last column is not a node but the centre, eta = 0. It is evaluated together with the nodes and
  // separated afterwards.
  for (Eigen::Index q = 0; q <= nodes; ++q) {
    const double t = q == nodes ? 0 : basis.rule_.x[static_cast<std::size_t>(q)];
    // b is the factor (1 - t^2)^power with its two derivatives. The Legendre polynomials and their two
    // derivatives come from a recurrence.
    const double u = 1 - t * t;
    const double b = power == 1 ? u : u * u;
    const double b1 = power == 1 ? -2 * t : -4 * t * u;
    const double b2 = power == 1 ? -2 : -4 * u + 8 * t * t;
    double p0 = 1, p1 = t, d0 = 0, d1 = 1, s0 = 0, s1 = 0;
    for (int k = 0; k < 2 * count; ++k) {
      if (k % 2 == (parity == Parity::odd)) {
        const double scale = std::sqrt(2 * k + 1.0);
        if (q == nodes) {
          basis.centre[k / 2] = scale * b * p0;
        } else {
          basis.value_(k / 2, q) = scale * b * p0;
          basis.first_(k / 2, q) = scale * (b1 * p0 + b * d0);
          basis.second_(k / 2, q) = scale * (b2 * p0 + 2 * b1 * d0 + b * s0);
        }
      }
      // The recurrence P_(k+2) = ((2k + 3) t P_(k+1) - (k + 1) P_k) / (k + 2), differentiated once and twice.
      const double n = k + 2;
      const double p2 = ((2 * n - 1) * t * p1 - (n - 1) * p0) / n;
      const double d2 = ((2 * n - 1) * (p1 + t * d1) - (n - 1) * d0) / n;
      const double s2 = ((2 * n - 1) * (2 * d1 + t * s1) - (n - 1) * s0) / n;
      p0 = p1, p1 = p2, d0 = d1, d1 = d2, s0 = s1, s1 = s2;
    }
  }
  basis.integrate();
  return basis;
}

TransverseBasis TransverseBasis::clamped_shape(double b, double g) {
  TransverseBasis basis;
  basis.rule_ = gauss_legendre(32);
  const auto nodes = static_cast<Eigen::Index>(basis.rule_.x.size());
  basis.value_.resize(1, nodes);
  basis.first_.resize(1, nodes);
  basis.second_.resize(1, nodes);
  // Computes cosh(g eta)/cosh g in a form that does not overflow for large g.
  const auto decay = [g](double t) { return std::exp(g * (t - 1)) / (1 + std::exp(-2 * g)); };
  const double unit = 1 / std::cos(b) - 2 * decay(0);
  for (Eigen::Index q = 0; q < nodes; ++q) {
    const double t = basis.rule_.x[static_cast<std::size_t>(q)];
    const double mirror = std::exp(-2 * g * t);
    const double even = decay(t) * (1 + mirror), odd = decay(t) * (1 - mirror);
    basis.value_(0, q) = (std::cos(b * t) / std::cos(b) - even) / unit;
    basis.first_(0, q) = (-b * std::sin(b * t) / std::cos(b) - g * odd) / unit;
    basis.second_(0, q) = (-b * b * std::cos(b * t) / std::cos(b) - g * g * even) / unit;
  }
  basis.centre = Eigen::VectorXd::Ones(1);
  basis.integrate();
  return basis;
}

void TransverseBasis::integrate() {
  const auto nodes = value_.cols();
  const Eigen::Map<const Eigen::VectorXd> eta(rule_.x.data(), nodes);
  const Eigen::Map<const Eigen::VectorXd> weight(rule_.w.data(), nodes);
  const std::array<Matrix, 4> parts{value_, first_ * eta.asDiagonal(),
                                    second_ * eta.cwiseProduct(eta).asDiagonal(), second_};
  const auto gram = [&](const Matrix& a, const Matrix& b) -> Matrix {
    count_operations(2 * static_cast<double>(a.size() * b.rows()));
    return a * weight.asDiagonal() * b.transpose();
  };
  mass = gram(value_, value_);
  stretch = gram(value_, parts[1]);
  shear = gram(parts[1], parts[1]);
  stiff = gram(first_, first_);
  for (std::size_t m = 0; m < 4; ++m) {
    for (std::size_t n = 0; n < 4; ++n) bend[m][n] = gram(parts[m], parts[n]);
  }
}

Eigen::VectorXd TransverseBasis::project(const std::function<double(double)>& shape) const {
  Eigen::VectorXd load = Eigen::VectorXd::Zero(value_.rows());
  for (Eigen::Index q = 0; q < value_.cols(); ++q) {
    const auto i = static_cast<std::size_t>(q);
    load += rule_.w[i] * shape(rule_.x[i]) * value_.col(q);
  }
  return mass.ldlt().solve(load);
}

}  // namespace turnpoint::physics

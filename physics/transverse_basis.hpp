#pragma once
// Basis functions of eta = y / W(x) for the two-dimensional field, and the integrals of their products in the
// weak form of the field equation.
#include <Eigen/Core>
#include <array>
#include <functional>
#include <vector>

namespace turnpoint::physics {

// Gauss-Legendre nodes and weights on [0, 1].
struct Quadrature {
  std::vector<double> x, w;
};
Quadrature gauss_legendre(int n);

// Whether functions are symmetric or antisymmetric about the centre line.
enum class Parity { even, odd };

// Adds (1 - eta^2)^power P_k(eta) sqrt(2k + 1) at one eta, times `times`, for the first even or odd k. The
// power is 1 or 2.
void add_bubbles(Eigen::VectorXd& sum, int power, Parity parity, double eta, double times);

// Even or odd functions Y_i of eta that vanish at eta = 1. They are (1 - eta^2)^m P_k(eta), with m = 1 for
// membranes, and m = 2 if the slope must vanish at eta = 1 as well. A basis may instead consist of one given
// shape. Integrals are over [0, 1].
class TransverseBasis {
 public:
  using Matrix = Eigen::MatrixXd;

  static TransverseBasis polynomials(int count, int power, Parity parity = Parity::even);
  // A basis of one function, the shape of a clamped strip at its cut-off: cos(b eta) / cos b - cosh(g eta) /
  // cosh g.
  static TransverseBasis clamped_shape(double b, double g);

  int count() const { return static_cast<int>(centre.size()); }
  // Fits the basis functions to this shape by least squares and returns their coefficients.
  Eigen::VectorXd project(const std::function<double(double)>& shape) const;

  Matrix mass;                                // integrals of Y_i Y_j
  Matrix stretch;                             // integrals of Y_i eta Y_j'
  Matrix shear;                               // integrals of eta^2 Y_i' Y_j'
  Matrix stiff;                               // integrals of Y_i' Y_j'
  std::array<std::array<Matrix, 4>, 4> bend;  // integrals of all products of (Y, eta Y', eta^2 Y'', Y'')
  Eigen::VectorXd centre;                     // the values Y_i(0)

 private:
  void integrate();
  Quadrature rule_;
  Matrix value_, first_, second_;  // Y_i and its derivatives: a row per function, a column per node
};

}  // namespace turnpoint::physics

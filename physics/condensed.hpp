#pragma once
// Eliminates the inner unknowns of a finite element. Needs Eigen.
#include <Eigen/Core>

namespace turnpoint::physics {

// The matrix of an element, with its inner unknowns (its bubbles) expressed by the unknowns of its two ends.
// It is complex and symmetric, K - omega^2 M. An element is shorter than half a wavelength, so the real part
// of the block that belongs to the bubbles is positive definite, and elimination needs no pivoting.
class Condensed {
 public:
  using Matrix = Eigen::MatrixXcd;
  using Vector = Eigen::VectorXcd;

  Condensed() = default;
  // The unknowns of the matrix real + i imaginary are in this order: those of the left end (`left` of them),
  // the inner ones (bubbles), those of the right end (`right` of them).
  Condensed(const Eigen::MatrixXd& real, const Eigen::MatrixXd& imaginary, Eigen::Index left,
            Eigen::Index right);

  Eigen::Index bubbles() const { return pivots_.size(); }
  // The matrix that remains for the unknowns of the two ends: first those of the left end, then those of the
  // right.
  const Matrix& ends() const { return ends_; }
  // Returns the values of the bubbles that belong to given values at the ends, if no load acts on the
  // bubbles.
  Vector follow(const Vector& ends) const;
  // reduce() prepares a load on the bubbles for the functions below. load_on_ends() returns the load that the
  // ends then feel; quadratic() returns load^T matrix^-1 load for a load on the bubbles alone.
  Vector reduce(const Vector& load) const;
  Vector load_on_ends(const Vector& reduced) const { return -(rows_ * reduced); }
  // Returns the values of the bubbles under the load that was passed to reduce(), with the unknowns of the
  // ends held at 0.
  Vector under(const Vector& reduced) const;
  std::complex<double> quadratic(const Vector& reduced) const {
    return reduced.cwiseProduct(reduced).cwiseQuotient(pivots_).sum();
  }

 private:
  Matrix lower_;   // unit lower triangular factor L of the block of the bubbles (inner unknowns), L D L^T
  Matrix rows_;    // the rows of the factor L for the unknowns of the ends
  Vector pivots_;  // the diagonal of D in L D L^T
  Matrix ends_;
};

// Eliminates the first `count` unknowns of a symmetric matrix of `size` rows. Real and imaginary part are
// stored by columns, and only the lower triangle is used. On return, the first `count` columns hold the
// pivots and, below them, the factors; the other columns hold the remaining matrix.
void eliminate_first(double* re, double* im, int size, int count);

}  // namespace turnpoint::physics

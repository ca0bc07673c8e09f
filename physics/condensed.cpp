#include "physics/condensed.hpp"

#include "physics/operations.hpp"

namespace turnpoint::physics {
namespace {

// Reorders the unknowns of a symmetric element matrix: first the inner ones (bubbles), then those of the two
// ends.
Eigen::MatrixXd bubbles_first(const Eigen::MatrixXd& from, Eigen::Index left, Eigen::Index right) {
  const Eigen::Index n = from.rows(), inner = n - left - right;
  Eigen::MatrixXd to(n, n);
  to.topLeftCorner(inner, inner) = from.block(left, left, inner, inner);
  to.block(inner, 0, left, inner) = from.block(0, left, left, inner);
  to.block(inner + left, 0, right, inner) = from.block(left + inner, left, right, inner);
  to.block(inner, inner, left, left) = from.topLeftCorner(left, left);
  to.block(inner + left, inner, right, left) = from.bottomLeftCorner(right, left);
  to.bottomRightCorner(right, right) = from.bottomRightCorner(right, right);
  return to;  // the rest of the upper triangle stays unset, because nothing reads it
}

}  // namespace

Condensed::Condensed(const Eigen::MatrixXd& real, const Eigen::MatrixXd& imaginary, Eigen::Index left,
                     Eigen::Index right) {
  Eigen::MatrixXd re = bubbles_first(real, left, right), im = bubbles_first(imaginary, left, right);
  const Eigen::Index n = re.rows(), ends = left + right, inner = n - ends;
  count_elimination(static_cast<double>(n), static_cast<double>(inner));
  eliminate_first(re.data(), im.data(), static_cast<int>(n), static_cast<int>(inner));
  const std::complex<double> i(0, 1);
  const auto block = [&](Eigen::Index row, Eigen::Index column, Eigen::Index rows, Eigen::Index columns) {
    return re.block(row, column, rows, columns) + i * im.block(row, column, rows, columns);
  };
  lower_ = block(0, 0, inner, inner);
  rows_ = block(inner, 0, ends, inner);
  pivots_ = lower_.diagonal();
  ends_ = block(inner, inner, ends, ends);
  for (Eigen::Index column = 1; column < ends; ++column)
    ends_.col(column).head(column) = ends_.row(column).head(column).transpose();
}

Condensed::Vector Condensed::follow(const Vector& ends) const {
  const auto inner = static_cast<double>(bubbles());
  count_operations(8 * inner * (0.5 * inner + static_cast<double>(ends.size())));
  return -lower_.triangularView<Eigen::UnitLower>().transpose().solve(rows_.transpose() * ends);
}

Condensed::Vector Condensed::under(const Vector& reduced) const {
  return lower_.triangularView<Eigen::UnitLower>().transpose().solve(reduced.cwiseQuotient(pivots_));
}

Condensed::Vector Condensed::reduce(const Vector& load) const {
  return lower_.triangularView<Eigen::UnitLower>().solve(load);
}

}  // namespace turnpoint::physics

#include "station/core/least_squares.hpp"

#include <Eigen/QR>
#include <cmath>

#include "station/core/texts.hpp"

namespace turnpoint::core {

LeastSquares least_squares(const std::vector<std::vector<double>>& rows, const std::vector<double>& values,
                           const std::vector<double>& weights) {
  const auto m = static_cast<Eigen::Index>(rows.size()), n = static_cast<Eigen::Index>(rows.front().size());
  Eigen::MatrixXd matrix(m, n);
  for (Eigen::Index i = 0; i < m; ++i)
    matrix.row(i) = Eigen::Map<const Eigen::RowVectorXd>(rows[static_cast<std::size_t>(i)].data(), n);
  const Eigen::VectorXd root = Eigen::Map<const Eigen::VectorXd>(weights.data(), m).cwiseSqrt();
  matrix = root.asDiagonal() * matrix;
  const Eigen::VectorXd right = root.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(values.data(), m));
  Eigen::RowVectorXd scale = matrix.colwise().norm();
  for (double& s : scale)
    if (s == 0) s = 1;
  matrix.array().rowwise() /= scale.array();

  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  // A column counts as linearly dependent if the part of it that is orthogonal to the other columns is below
  // this fraction of its length.
  qr.setThreshold(3e-7);
  if (qr.rank() < n) throw Refusal(core::phrase("fitted.too_few"));
  const Eigen::VectorXd solution = qr.solve(right);
  // The covariance is (R'R)^-1, with R of the QR decomposition; its rows are in the order of the pivots.
  const Eigen::MatrixXd inverse =
      qr.matrixR().topLeftCorner(n, n).triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::VectorXd sd = qr.colsPermutation() * inverse.rowwise().norm();
  const double variance = m > n ? (right - matrix * solution).squaredNorm() / static_cast<double>(m - n) : 0;
  LeastSquares fit;
  for (Eigen::Index k = 0; k < n; ++k) {
    fit.value.push_back(solution(k) / scale(k));
    fit.known_sd.push_back(sd(k) / scale(k));
    fit.sd.push_back(std::sqrt(variance) * fit.known_sd.back());
  }
  return fit;
}

}  // namespace turnpoint::core

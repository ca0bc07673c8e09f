#include "station/calibration/least_squares.hpp"

#include <cmath>

#include "station/terms/usage_error.hpp"

namespace turnpoint::calibration {
namespace {

using Matrix = std::vector<std::vector<double>>;

// Inverse of a small symmetric positive definite matrix, by Gauss-Jordan elimination.
Matrix inverse(Matrix a) {
  const std::size_t n = a.size();
  Matrix b(n, std::vector<double>(n, 0));
  for (std::size_t k = 0; k < n; ++k) b[k][k] = 1;
  for (std::size_t k = 0; k < n; ++k) {
    const double pivot = a[k][k];
    if (!(pivot > 1e-13)) throw terms::UsageError("the measured points do not determine the fit");
    for (std::size_t j = 0; j < n; ++j) {
      a[k][j] /= pivot;
      b[k][j] /= pivot;
    }
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i][k];
      for (std::size_t j = 0; j < n; ++j) {
        a[i][j] -= factor * a[k][j];
        b[i][j] -= factor * b[k][j];
      }
    }
  }
  return b;
}

}  // namespace

LeastSquares least_squares(const Matrix& rows, const std::vector<double>& values,
                           const std::vector<double>& weights) {
  const std::size_t n = rows.front().size(), m = rows.size();
  std::vector<double> scale(n, 0);
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t k = 0; k < n; ++k) scale[k] += weights[i] * rows[i][k] * rows[i][k];
  for (double& s : scale) s = std::sqrt(s);
  Matrix normal(n, std::vector<double>(n, 0));
  std::vector<double> right(n, 0);
  for (std::size_t i = 0; i < m; ++i)
    for (std::size_t k = 0; k < n; ++k) {
      right[k] += weights[i] * rows[i][k] / scale[k] * values[i];
      for (std::size_t j = 0; j < n; ++j)
        normal[k][j] += weights[i] * rows[i][k] / scale[k] * rows[i][j] / scale[j];
    }
  const Matrix covariance = inverse(normal);
  LeastSquares fit;
  for (std::size_t k = 0; k < n; ++k) {
    double value = 0;
    for (std::size_t j = 0; j < n; ++j) value += covariance[k][j] * right[j];
    fit.value.push_back(value / scale[k]);
  }
  double chi = 0;
  for (std::size_t i = 0; i < m; ++i) {
    double residual = values[i];
    for (std::size_t k = 0; k < n; ++k) residual -= rows[i][k] * fit.value[k];
    chi += weights[i] * residual * residual;
  }
  const double variance = m > n ? chi / static_cast<double>(m - n) : 0;
  for (std::size_t k = 0; k < n; ++k) {
    fit.known_sd.push_back(std::sqrt(covariance[k][k]) / scale[k]);
    fit.sd.push_back(std::sqrt(variance) * fit.known_sd.back());
  }
  return fit;
}

}  // namespace turnpoint::calibration

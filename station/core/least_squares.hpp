#pragma once
#include <vector>

namespace turnpoint::core {

/// The result of a linear least-squares fit.
struct LeastSquares {
  std::vector<double> value;
  /// standard errors estimated from the residuals; 0 if there are as many points as parameters
  std::vector<double> sd;
  /// standard errors that follow from the weights alone, if each weight is 1 / variance
  std::vector<double> known_sd;
};

/// Minimises sum w (y - row . value)^2 by Householder QR with column pivoting (columns scaled to unit
/// length). Throws UsageError if the columns are linearly dependent.
LeastSquares least_squares(const std::vector<std::vector<double>>& rows, const std::vector<double>& values,
                           const std::vector<double>& weights);

}  // namespace turnpoint::core

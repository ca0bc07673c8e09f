#pragma once
// Solves non-negative least squares.
#include <span>
#include <vector>

namespace turnpoint::physics {

struct NnlsResult {
  std::vector<double> x;     // weight of each column, at least 0
  double residual_norm = 0;  // |A x - b|
  int iterations = 0;
};

// Minimises |A x - b| with x >= 0 by the active-set method of Lawson & Hanson (1974, ch. 23). `columns`
// contains the matrix column by column, with `rows` numbers each; throws std::invalid_argument if the sizes
// do not fit. The normal equations of the passive set are factorised by Cholesky and refined once, which is
// accurate enough unless columns are nearly equal.
NnlsResult nnls(std::span<const double> columns, std::size_t rows, std::span<const double> b,
                double tolerance = 1e-13);

}  // namespace turnpoint::physics

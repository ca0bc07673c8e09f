#pragma once
// Non-negative least squares.
#include <span>
#include <vector>

namespace turnpoint::physics {

struct NnlsResult {
  std::vector<double> x;     // one per column, all >= 0
  double residual_norm = 0;  // |A x - b|
  int iterations = 0;
};

// min |A x - b|, x >= 0, by the active-set method of Lawson & Hanson (1974, ch. 23). `columns` holds the
// matrix column by column, `rows` numbers each; throws std::invalid_argument when the sizes do not fit. The
// passive set's normal equations are factorised by Cholesky and refined once, which is enough for columns
// that are distinct.
NnlsResult nnls(std::span<const double> columns, std::size_t rows, std::span<const double> b,
                double tolerance = 1e-13);

}  // namespace turnpoint::physics

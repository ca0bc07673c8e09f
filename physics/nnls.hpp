#pragma once
// Solves least-squares problems whose solution must not be negative (NNLS).
#include <span>
#include <vector>

namespace turnpoint::physics {

struct NnlsResult {
  std::vector<double> x;     // weight of each column, at least 0
  double residual_norm = 0;  // the norm |A x - b|
  int iterations = 0;
};

// Minimises |A x - b| with x >= 0 by the active-set method of Lawson & Hanson (1974, ch. 23). `columns`
// contains the matrix column by column, with `rows` numbers each; std::invalid_argument is thrown if the
// sizes do not fit. The normal equations are solved by Cholesky factorisation and one step of refinement,
// which is accurate unless columns are nearly equal.
NnlsResult nnls(std::span<const double> columns, std::size_t rows, std::span<const double> b,
                double tolerance = 1e-13);

}  // namespace turnpoint::physics

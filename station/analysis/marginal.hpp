#pragma once
#include <vector>

namespace turnpoint::analysis {

/// Cells of equal width from low to high; a single cell may have no width.
struct Cells {
  double low = 0, high = 1;
  int count = 1;

  double width() const { return (high - low) / count; }
  double edge(int i) const { return i == count ? high : low + i * width(); }
  double centre(int i) const { return low + (i + 0.5) * width(); }
};

/// A distribution with constant density within each cell.
class Marginal {
 public:
  /// One mass a cell, of any sum above 0; throws std::invalid_argument for another number of masses.
  Marginal(const Cells& cells, std::vector<double> mass);

  const Cells& cells() const { return cells_; }
  const std::vector<double>& mass() const { return mass_; }
  /// p in [0, 1]; for 0 and 1 the ends of the cells.
  double quantile(double p) const;

 private:
  Cells cells_;
  std::vector<double> mass_, cumulative_;  ///< cumulative_[i]: mass below edge i
};

}  // namespace turnpoint::analysis

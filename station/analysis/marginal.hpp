#pragma once
#include <vector>

namespace turnpoint::analysis {

/// A range divided into cells of equal width. A single cell may have width 0.
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
  /// Takes the probability mass of each cell. The masses may have any sum above 0. Throws
  /// std::invalid_argument if the number of masses is wrong.
  Marginal(const Cells& cells, std::vector<double> mass);

  const Cells& cells() const { return cells_; }
  const std::vector<double>& mass() const { return mass_; }
  /// Returns the quantile for p in [0, 1]; p = 0 and p = 1 give the outer ends of the cells.
  double quantile(double p) const;

 private:
  Cells cells_;
  std::vector<double> mass_, cumulative_;  ///< cumulative_[i] is the total mass below edge i of the cells
};

}  // namespace turnpoint::analysis

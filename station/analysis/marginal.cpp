#include "station/analysis/marginal.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace turnpoint::analysis {

Marginal::Marginal(const Cells& cells, std::vector<double> mass)
    : cells_(cells), mass_(std::move(mass)), cumulative_{0} {
  if (mass_.empty() || static_cast<int>(mass_.size()) != cells_.count)
    throw std::invalid_argument("marginal: there must be at least one cell, and one mass for each cell");
  for (const double value : mass_) cumulative_.push_back(cumulative_.back() + value);
}

double Marginal::quantile(double p) const {
  if (p <= 0) return cells_.low;
  if (p >= 1) return cells_.high;
  const double wanted = p * cumulative_.back();
  const auto above = std::upper_bound(cumulative_.begin() + 1, cumulative_.end() - 1, wanted);
  const auto cell = static_cast<std::size_t>(above - cumulative_.begin()) - 1;
  const double inside = mass_[cell] > 0 ? (wanted - cumulative_[cell]) / mass_[cell] : 0.5;
  return cells_.edge(static_cast<int>(cell)) + std::clamp(inside, 0.0, 1.0) * cells_.width();
}

}  // namespace turnpoint::analysis

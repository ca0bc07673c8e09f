#include "physics/nnls.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace turnpoint::physics {
namespace {

double dot(std::span<const double> a, std::span<const double> b) {
  // Four partial sums let the compiler use vector instructions. They also fix the order of the additions.
  double s[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (; i + 4 <= a.size(); i += 4) {
    for (std::size_t j = 0; j < 4; ++j) s[j] += a[i + j] * b[i + j];
  }
  for (; i < a.size(); ++i) s[0] += a[i] * b[i];
  return (s[0] + s[1]) + (s[2] + s[3]);
}

class Solver {
 public:
  Solver(std::span<const double> columns, std::size_t rows, std::span<const double> b)
      : columns_(columns), rows_(rows), b_(b), x_(columns.size() / rows, 0.0), r_(b.begin(), b.end()) {
    blocked_.assign(x_.size(), false);
    gram_.assign(x_.size() * x_.size(), -1);
  }

  NnlsResult run(double relative) {
    double scale = 0;
    for (std::size_t j = 0; j < x_.size(); ++j) scale = std::max(scale, std::abs(dot(column(j), b_)));
    const double tolerance = relative * scale;
    const int most = 3 * static_cast<int>(x_.size()) + 10;
    int iterations = 0;
    while (iterations < most) {
      const auto enter = steepest(tolerance);
      if (enter == x_.size()) break;
      ++iterations;
      passive_.push_back(enter);
      descend(enter);
    }
    return {x_, std::sqrt(dot(r_, r_)), iterations};
  }

 private:
  std::span<const double> column(std::size_t j) const { return columns_.subspan(j * rows_, rows_); }

  // Returns the column that reduces the residual fastest, of those outside the passive set (the columns with
  // a weight above 0). Returns size() if no column reduces it.
  std::size_t steepest(double tolerance) {
    std::size_t best = x_.size();
    double most = tolerance;
    for (std::size_t j = 0; j < x_.size(); ++j) {
      if (blocked_[j] || std::find(passive_.begin(), passive_.end(), j) != passive_.end()) continue;
      const double gain = dot(column(j), r_);
      if (gain > most) {
        most = gain;
        best = j;
      }
    }
    return best;
  }

  // Solves for the weights of the passive set. While the solution has a negative weight, moves towards the
  // solution only until the first weight reaches 0, and takes columns of weight 0 out of the set.
  void descend(std::size_t entered) {
    while (!passive_.empty()) {
      std::vector<double> z = solve_passive();
      // Rounding can make a column look useful although its weight comes out negative. Exclude this column
      // until another one has been added.
      if (passive_.back() == entered && !(z.back() > 0)) {
        passive_.pop_back();
        blocked_[entered] = true;
        return;
      }
      double step = 1;
      for (std::size_t i = 0; i < passive_.size(); ++i) {
        if (z[i] <= 0) step = std::min(step, x_[passive_[i]] / (x_[passive_[i]] - z[i]));
      }
      for (std::size_t i = 0; i < passive_.size(); ++i) {
        double& x = x_[passive_[i]];
        x = step == 1 ? z[i] : x + step * (z[i] - x);
        if (step < 1 && (z[i] <= 0 && x <= 1e-15 * std::abs(z[i]))) x = 0;
      }
      update_residual();
      if (step == 1) {
        std::fill(blocked_.begin(), blocked_.end(), false);
        return;
      }
      std::erase_if(passive_, [this](std::size_t j) { return !(x_[j] > 0); });
      entered = x_.size();
    }
  }

  void update_residual() {
    std::copy(b_.begin(), b_.end(), r_.begin());
    for (const std::size_t j : passive_) {
      const auto a = column(j);
      for (std::size_t i = 0; i < rows_; ++i) r_[i] -= x_[j] * a[i];
    }
  }

  std::vector<double> solve_passive() {
    factorise();
    std::vector<double> z(passive_.size());
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = dot(column(passive_[i]), b_);
    back_substitute(z);
    // The normal equations square the condition number, which costs accuracy. One step of iterative
    // refinement restores it.
    std::vector<double> r(b_.begin(), b_.end());
    for (std::size_t i = 0; i < z.size(); ++i) {
      const auto a = column(passive_[i]);
      for (std::size_t k = 0; k < rows_; ++k) r[k] -= z[i] * a[k];
    }
    std::vector<double> correction(z.size());
    for (std::size_t i = 0; i < z.size(); ++i) correction[i] = dot(column(passive_[i]), r);
    back_substitute(correction);
    for (std::size_t i = 0; i < z.size(); ++i) z[i] += correction[i];
    return z;
  }

  // The dot product of two columns. Each product is computed when first needed and kept, because an iteration
  // changes only one or two columns of the passive set.
  double gram(std::size_t i, std::size_t j) {
    if (i < j) std::swap(i, j);
    double& product = gram_[i * x_.size() + j];
    if (product < 0) product = dot(column(i), column(j));
    // a negative entry means "not computed", so a negative product is computed each time
    if (product < 0) return dot(column(i), column(j));
    return product;
  }

  void factorise() {
    const std::size_t n = passive_.size();
    factor_.assign(n * n, 0);
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = gram(passive_[i], passive_[j]);
        const double diagonal = sum;
        for (std::size_t k = 0; k < j; ++k) sum -= factor_[i * n + k] * factor_[j * n + k];
        if (i == j) sum = std::sqrt(std::max(sum, 1e-15 * diagonal));
        factor_[i * n + j] = i == j ? sum : sum / factor_[j * n + j];
      }
    }
  }

  void back_substitute(std::vector<double>& y) const {
    const std::size_t n = y.size();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) y[i] -= factor_[i * n + k] * y[k];
      y[i] /= factor_[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) y[i] -= factor_[k * n + i] * y[k];
      y[i] /= factor_[i * n + i];
    }
  }

  std::span<const double> columns_;
  std::size_t rows_;
  std::span<const double> b_;
  std::vector<double> x_, r_, factor_, gram_;
  std::vector<std::size_t> passive_;
  std::vector<bool> blocked_;
};

}  // namespace

NnlsResult nnls(std::span<const double> columns, std::size_t rows, std::span<const double> b,
                double tolerance) {
  if (rows == 0 || b.size() != rows || columns.size() % rows != 0) {
    throw std::invalid_argument(
        "non-negative least squares: sizes of the matrix and the right side do not fit");
  }
  return Solver(columns, rows, b).run(tolerance);
}

}  // namespace turnpoint::physics

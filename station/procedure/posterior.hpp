#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

/// The posterior over a grid of threshold, slope, guess and lapse, with the probability of a 1 tabulated for
/// every stimulus. Memory: 16 bytes for each stimulus and grid point (8 with nuisance parameters).
class Posterior {
 public:
  enum Parameter { threshold, slope, guess, lapse };

  explicit Posterior(const Spec& spec);

  /// Index of the stimulus that tells most about the kept parameters: the largest mutual information, which
  /// has the same maximum as the least expected entropy. The first wins a tie.
  std::size_t best_stimulus() const;
  /// Mutual information (nats) of each stimulus.
  std::vector<double> information() const;
  /// Probability of a 1 at a stimulus, as far as is known.
  double predictive(std::size_t stimulus) const;
  /// Learns from an answer at a stimulus.
  void update(std::size_t stimulus, bool one);

  /// Mean and sd of the parameter's marginal; mode: its value at the largest weight of the whole grid, as in
  /// Watson (2017), which need not be where the marginal is largest.
  Estimate estimate(Parameter parameter) const;
  /// Has more than one value on the grid and is not tied.
  bool varies(Parameter parameter) const { return values_[parameter].size() > 1; }
  double entropy_nats() const;
  const std::vector<double>& stimuli() const { return stimuli_; }
  std::size_t size() const { return weights_.size(); }
  /// Of the tables and the weights.
  std::size_t memory_bytes() const;

 private:
  std::vector<double> marginal(Parameter parameter) const;
  std::size_t index_of(std::size_t point, Parameter parameter) const;
  double kept_entropy(std::size_t stimulus, std::vector<double>& scratch) const;

  std::vector<double> stimuli_;
  std::array<std::vector<double>, 4> values_;
  std::array<std::size_t, 4> stride_{};
  std::vector<double> weights_;
  std::vector<double> p_;          ///< [stimulus][point]
  std::vector<double> entropy_;    ///< [stimulus][point], without nuisance parameters
  std::vector<std::size_t> kept_;  ///< point -> group of kept parameters; empty without nuisance
  std::size_t groups_ = 0;
};

}  // namespace turnpoint::procedure

#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

/// The posterior over a grid of threshold, slope, guess and lapse. The functions depend on stimulus and
/// threshold by their distance only, and on guess and lapse affinely, so what is tabulated is small: the
/// function between its asymptotes and the entropy of the answer, for each distance that occurs (on grids of
/// commensurate steps their number is about that of stimuli plus thresholds, else their product).
/// Memory: 8 bytes a grid point, and 8 for each distance and value of slope, guess and lapse.
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
  using Axes = std::array<std::vector<double>, 4>;
  void set_asymptotes(const Spec& spec);
  void set_weights(const Spec& spec);
  void set_rows(const Spec& spec);
  void set_groups(const Spec& spec);
  std::vector<double> sums(const std::vector<double>& factors, const std::vector<double>& table,
                           std::size_t length) const;
  std::vector<double> predictives() const;
  std::vector<double> kept_entropies() const;
  std::vector<double> marginal(Parameter parameter) const;
  std::size_t index_of(std::size_t point, Parameter parameter) const;
  std::size_t row(std::size_t stimulus, std::size_t at_threshold) const {
    return rows_[stimulus * values_[threshold].size() + at_threshold];
  }

  std::vector<double> stimuli_;
  Axes values_;
  std::array<std::size_t, 4> stride_{};
  std::size_t slopes_ = 1, padded_slopes_ = 1,
              ends_ = 1;                  ///< values of the slope; of guess and lapse together
  std::vector<double> guesses_, ranges_;  ///< [guess and lapse]: guess, 1 - guess - lapse
  std::vector<double> weights_;           ///< [threshold][slope][guess][lapse]
  std::vector<std::uint32_t> rows_;       ///< [stimulus][threshold]: which distance
  std::vector<double> core_;              ///< [distance][slope, padded]: the function from 0 to 1
  std::vector<double> entropy_;           ///< [distance][slope][guess][lapse], without nuisance parameters
  std::vector<std::uint32_t> kept_;       ///< point -> group of kept parameters; empty without nuisance
  std::size_t groups_ = 0;
};

}  // namespace turnpoint::procedure

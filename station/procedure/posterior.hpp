#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

/// The posterior on a grid of threshold, slope, guess and lapse. The functions depend only on the distance
/// between stimulus and threshold, and are affine in guess and lapse, so the tables are small: the function
/// between its asymptotes and the entropy of the answer, for each distance that occurs. On grids with
/// commensurate steps the number of distances is about that of stimuli plus thresholds, otherwise their
/// product. Memory: 8 bytes per grid point, and 8 for each combination of a distance and a value of slope,
/// guess and lapse.
class Posterior {
 public:
  enum Parameter { threshold, slope, guess, lapse };

  explicit Posterior(const Spec& spec);

  /// Index of the stimulus that is expected to tell most about the kept parameters. It maximises mutual
  /// information, which is the same as minimising the expected entropy. Ties go to the first.
  std::size_t best_stimulus() const;
  /// Mutual information (nats) of each stimulus.
  std::vector<double> information() const;
  /// Posterior predictive probability of response 1 at this stimulus.
  double predictive(std::size_t stimulus) const;
  /// Updates the posterior with an answer at a stimulus.
  void update(std::size_t stimulus, bool one);

  /// Mean and sd of the parameter's marginal. The mode is its value at the point of largest weight in the
  /// whole grid, as in Watson (2017), which need not be the maximum of the marginal.
  Estimate estimate(Parameter parameter) const;
  /// True if the parameter has more than one value on the grid and is not tied.
  bool varies(Parameter parameter) const { return values_[parameter].size() > 1; }
  double entropy_nats() const;
  const std::vector<double>& stimuli() const { return stimuli_; }
  std::size_t size() const { return weights_.size(); }
  /// Memory used by the tables and the weights.
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
              /// number of values of the slope, and of combinations of guess and lapse
      ends_ = 1;
  /// guess, and 1 - guess - lapse, for each combination of guess and lapse
  std::vector<double> guesses_, ranges_;
  std::vector<double> weights_;      ///< posterior weights, indexed by [threshold][slope][guess][lapse]
  std::vector<std::uint32_t> rows_;  ///< index of the distance, for [stimulus][threshold]
  /// value of the function between its asymptotes, 0 to 1, for [distance][slope, padded]
  std::vector<double> core_;
  /// entropy of the answer for [distance][slope][guess][lapse], used if there are no nuisance parameters
  std::vector<double> entropy_;
  /// group of kept parameters for each grid point; empty without nuisance parameters
  std::vector<std::uint32_t> kept_;
  std::size_t groups_ = 0;
};

}  // namespace turnpoint::procedure

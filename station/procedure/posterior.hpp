#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

/// The posterior on a grid of threshold, slope, guess and lapse.
///
/// The psychometric function depends on stimulus and threshold only through their distance, and linearly on
/// guess and lapse. Small tables are therefore enough. They hold, for each distance that occurs, the function
/// between its asymptotes, and the entropy of the answer. If the steps of stimuli and thresholds are
/// commensurate, the number of distances is about the number of stimuli plus the number of thresholds;
/// otherwise it is their product. Memory: 8 bytes per grid point, and 8 bytes for each combination of
/// distance, slope, guess and lapse.
class Posterior {
 public:
  enum Parameter { threshold, slope, guess, lapse };

  explicit Posterior(const Spec& spec);

  /// Returns the index of the stimulus from whose answer most information about the kept parameters is
  /// expected: the one with the largest mutual information, that is, the smallest expected entropy. If
  /// several are equal, returns the first.
  std::size_t best_stimulus() const;
  /// Returns the index of the stimulus that is nearest to a level on this scale; of two equally near, the
  /// first.
  std::size_t nearest_stimulus(double level, Scale scale) const;
  /// Returns the threshold of largest weight, summed over the other parameters. If several are equal, as
  /// before the first answer, returns their mean.
  double most_likely_threshold() const;
  /// Returns the mutual information (nats) of each stimulus.
  std::vector<double> information() const;
  /// Returns the posterior predictive probability of answer 1 at this stimulus.
  double predictive(std::size_t stimulus) const;
  void update(std::size_t stimulus, bool one);

  /// Returns mean and sd of the parameter's marginal. The mode is the parameter's value at the grid point of
  /// largest weight, as in Watson (2017); this need not be the maximum of the marginal.
  Estimate estimate(Parameter parameter) const;
  /// True if the parameter has more than one value on the grid and is not tied to another parameter.
  bool varies(Parameter parameter) const { return values_[parameter].size() > 1; }
  double entropy_nats() const;
  const std::vector<double>& stimuli() const { return stimuli_; }
  std::size_t size() const { return weights_.size(); }
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
  /// number of slopes; the same number rounded up to whole groups, for fast sums; number of combinations of
  /// guess and lapse
  std::size_t slopes_ = 1, padded_slopes_ = 1, ends_ = 1;
  /// guess, and 1 - guess - lapse, for each combination of guess and lapse
  std::vector<double> guesses_, ranges_;
  std::vector<double> weights_;  ///< posterior weights, indexed by [threshold][slope][guess][lapse]
  /// index of the distance between stimulus and threshold, for [stimulus][threshold]
  std::vector<std::uint32_t> rows_;
  /// value of the function between its asymptotes, from 0 to 1, for [distance][slope, padded]
  std::vector<double> core_;
  /// entropy of the answer for [distance][slope][guess][lapse]; used only without nuisance parameters
  std::vector<double> entropy_;
  /// for each grid point, the number of its group; a group consists of points with the same kept parameters;
  /// empty without nuisance parameters
  std::vector<std::uint32_t> kept_;
  std::size_t groups_ = 0;
};

}  // namespace turnpoint::procedure

#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "station/procedure/procedure.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

/// The posterior on a grid of all parameters (kParameters).
///
/// The threshold at a stimulus follows from its second dimension, if there is one, and from a place: a
/// combination of threshold, gradient and floor. The probability of an answer depends on stimulus and place
/// only through the distance of the level from that threshold, and linearly on guess and lapse. Small tables
/// are therefore enough. They hold, for each distance that occurs and each shape (slope and criterion), the
/// function between its asymptotes, and the entropy of the answer. If the steps of stimuli and thresholds are
/// commensurate, the number of distances is about the number of stimuli plus the number of places; otherwise
/// it is their product. Memory: 8 bytes per grid point, 4 for each combination of stimulus and place, and 8
/// for each combination of distance, shape, guess and lapse.
class Posterior {
 public:
  /// The parameters, in the order of kParameters.
  enum Parameter { threshold, gradient, floor, slope, criterion, guess, lapse };

  struct Stimulus {
    double level = 0;
    double second = 0;  ///< value of the second dimension; 0 if there is none
  };

  explicit Posterior(const Spec& spec);

  /// Returns the index of the stimulus from whose answer most information about the kept parameters is
  /// expected: the one with the largest mutual information, that is, the smallest expected entropy. If
  /// several are equal, returns the first: the one with the lowest level, and of these the one with the
  /// lowest value of the second dimension.
  std::size_t best_stimulus() const;
  /// Returns the index of the stimulus that is nearest to a level on this scale; of two equally near, the
  /// first.
  std::size_t nearest_stimulus(double level, Scale scale) const;
  /// Returns the threshold of largest weight, summed over the other parameters. If several are equal, as
  /// before the first answer, returns their mean.
  double most_likely_threshold() const;
  /// Returns for each stimulus the mutual information (nats) between its answer and the parameters that are
  /// not nuisance parameters.
  std::vector<double> information() const;
  /// Returns the posterior predictive probability of answer 1 at this stimulus.
  double predictive(std::size_t stimulus) const;
  void update(std::size_t stimulus, bool one);

  /// Returns mean, SD and central 95 % interval of the parameter's marginal. The mode is the parameter's
  /// value at the grid point of largest weight, as in Watson (2017); this need not be the maximum of the
  /// marginal.
  Estimate estimate(Parameter parameter) const;
  /// Mean and SD alone, as in estimate(); they take less time.
  double mean(Parameter parameter) const;
  double sd(Parameter parameter) const;
  /// Returns the estimate of the threshold at each value of the second dimension. Empty if there is none.
  std::vector<ThresholdAt> thresholds() const;
  /// True if the parameter has more than one value on the grid and is not tied to another parameter.
  bool varies(Parameter parameter) const { return values_[parameter].size() > 1; }
  double entropy_nats() const;
  const std::vector<Stimulus>& stimuli() const { return stimuli_; }
  std::size_t size() const { return weights_.size(); }
  std::size_t memory_bytes() const;

 private:
  using Axes = std::array<std::vector<double>, kParameters.size()>;
  void set_stimuli(const Spec& spec);
  void set_asymptotes(const Spec& spec);
  void set_weights(const Spec& spec);
  void set_rows(const Spec& spec);
  void set_core(const Spec& spec, const std::vector<std::pair<std::size_t, std::size_t>>& distinct);
  void set_groups(const Spec& spec);
  double threshold_of(std::size_t place, double second) const;
  std::vector<double> sums(const std::vector<double>& factors, const std::vector<double>& table,
                           std::size_t length, const std::vector<std::size_t>& matter) const;
  std::vector<std::size_t> places_that_matter() const;
  std::vector<double> predictives(const std::vector<std::size_t>& matter) const;
  std::vector<double> kept_entropies(const std::vector<std::size_t>& matter) const;
  std::vector<double> marginal(Parameter parameter) const;
  std::size_t index_of(std::size_t point, Parameter parameter) const;
  std::size_t row(std::size_t stimulus, std::size_t place) const { return rows_[stimulus * places_ + place]; }

  std::vector<Stimulus> stimuli_;
  std::vector<double> seconds_;  ///< values of the second dimension; empty if there is none
  double origin_ = 0;
  Scale scale_ = Scale::linear;
  bool floored_ = false;  ///< true if the threshold has a floor
  Axes values_;
  std::array<std::size_t, kParameters.size()> stride_{};
  /// numbers of places and of shapes; the latter rounded up to whole groups, for fast sums; number of
  /// combinations of guess and lapse
  std::size_t places_ = 1, shapes_ = 1, padded_shapes_ = 1, ends_ = 1;
  /// guess, and 1 - guess - lapse, for each combination of guess and lapse
  std::vector<double> guesses_, ranges_;
  std::vector<double> weights_;  ///< posterior weights, indexed by [place][shape][guess][lapse]
  /// index of the distance between stimulus and threshold, for [stimulus][place]
  std::vector<std::uint32_t> rows_;
  /// value of the function between its asymptotes, from 0 to 1, for [distance][shape, padded]
  std::vector<double> core_;
  /// entropy of the answer for [distance][shape][guess][lapse]; used only without nuisance parameters
  std::vector<double> entropy_;
  /// for each grid point, the number of its group; a group consists of points with the same kept parameters;
  /// empty without nuisance parameters
  std::vector<std::uint32_t> kept_;
  std::size_t groups_ = 0;
};

}  // namespace turnpoint::procedure

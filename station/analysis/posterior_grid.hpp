#pragma once
#include <array>
#include <optional>
#include <vector>

#include "station/analysis/fit_bounds.hpp"
#include "station/analysis/marginal.hpp"

namespace turnpoint::analysis {

/// The axes of the grid, in the order of Theta. The threshold is given by its axis_position(), the rate by
/// its logarithm.
enum Parameter { at_threshold, at_rate, at_lapse, at_guess };
constexpr std::size_t kParameters = 4;
using Box = std::array<Cells, kParameters>;

/// The posterior of a psychometric function, computed on a grid. The prior is uniform for lapse and guess.
/// For threshold and rate it is flat in the middle and falls linearly to 0 towards both ends of the range.
class PosteriorGrid {
 public:
  /// Evaluates several coarse grids, each on the part of the previous grid that has noticeable probability,
  /// until that part hardly shrinks. Then evaluates a fine grid. A parameter whose cells have no width is
  /// fixed. With Guess::tied_to_lapse, the guess equals the lapse and the cells of the guess are ignored.
  /// `counts` must have at least one level.
  PosteriorGrid(Function function, Guess guess, const AxisCounts& counts, const Box& prior,
                double falling_share);

  Marginal marginal(Parameter parameter) const;
  /// Returns the marginal distribution of the position on the axis at which the probability is `p`. Empty if
  /// no such position exists for most of the posterior.
  std::optional<Marginal> marginal_of_crossing(double p) const;
  /// Returns the marginal distribution of the probability at the axis_position() `u`.
  Marginal marginal_of_probability(double u) const;

  /// True if the data exclude neither end of the prior. An interval would then merely repeat the prior. The
  /// data exclude an end if, under a flat prior, the likelihood ratio between the maximum and that end
  /// exceeds its 95 % limit.
  bool undetermined(Parameter parameter) const { return open_low(parameter) && open_high(parameter); }
  /// True if the data do not exclude the low or the high end of the prior. At that end, the prior limits the
  /// parameter, not the data.
  bool open_low(Parameter parameter) const;
  bool open_high(Parameter parameter) const;

 private:
  struct Asymptotes {
    double low = 0, range = 1;  ///< `low` is the guess, `range` is 1 - guess - lapse
  };
  void evaluate(const Box& box);
  void add_log_likelihoods(const std::vector<double>& between);
  Box narrowed() const;
  void set_weights(double falling_share);
  double prior_density(Parameter parameter, int cell, double falling_share) const;
  Marginal marginal(Parameter parameter, const std::vector<double>& weights) const;
  std::vector<Asymptotes> asymptotes() const;
  double rate(int cell) const;
  std::size_t stride(std::size_t parameter) const;

  Function function_;
  Guess guess_;
  AxisCounts counts_;
  Box prior_, box_;
  std::vector<Asymptotes> ends_;        ///< indexed by [lapse][guess]
  std::vector<double> log_likelihood_;  ///< indexed by [threshold][rate][lapse][guess]
  /// posterior weight of each cell, with the prior and with a flat prior; same index as log_likelihood_
  std::vector<double> weight_, flat_;
};

}  // namespace turnpoint::analysis

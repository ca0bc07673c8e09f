#pragma once
#include <array>
#include <optional>
#include <vector>

#include "station/analysis/fit_bounds.hpp"
#include "station/analysis/marginal.hpp"

namespace turnpoint::analysis {

/// Axes of the grid, in the order of Theta: threshold on the function's axis, ln rate, lapse, guess.
enum Parameter { at_threshold, at_rate, at_lapse, at_guess };
constexpr std::size_t kParameters = 4;
using Box = std::array<Cells, kParameters>;

/// The posterior of counts on a grid. The prior is uniform on each axis. For threshold and rate, however, the
/// density falls linearly to 0 over a share of the range at both ends.
class PosteriorGrid {
 public:
  /// Evaluates coarse grids, each restricted to the part of the previous one that matters, until a grid fills
  /// its box; then evaluates a fine grid. A parameter whose cells have no width is fixed. With
  /// Guess::tied_to_lapse the guess follows the lapse, whatever its cells are. `counts` has at least one
  /// level.
  PosteriorGrid(Function function, Guess guess, const AxisCounts& counts, const Box& prior,
                double falling_share);

  Marginal marginal(Parameter parameter) const;
  /// Marginal of the axis position at which the probability is `p`. Empty if no such position exists for most
  /// of the posterior.
  std::optional<Marginal> marginal_of_crossing(double p) const;
  /// Marginal of the probability at a position on the axis.
  Marginal marginal_of_probability(double u) const;

  /// True if the data exclude neither end of the prior; an interval would then merely repeat the prior. An
  /// end is not excluded if, under a flat prior, the density falls there by less than the 95 % likelihood
  /// ratio.
  bool undetermined(Parameter parameter) const { return open_low(parameter) && open_high(parameter); }
  /// True if the data do not exclude that end: there the prior limits the parameter, not the data.
  bool open_low(Parameter parameter) const;
  bool open_high(Parameter parameter) const;

 private:
  struct Asymptotes {
    double low = 0, range = 1;  ///< guess and 1 - guess - lapse
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
  /// same index: posterior weight with the prior, and with a flat prior
  std::vector<double> weight_, flat_;
};

}  // namespace turnpoint::analysis

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

/// The posterior of counts on a grid. The prior is uniform on each axis, but that its density falls linearly
/// to 0 over a share of the range at both ends of threshold and rate.
class PosteriorGrid {
 public:
  /// Evaluates coarse grids, each on the part that matters of the one before, until one fills its box, and
  /// then a fine grid. A parameter whose cells have no width is fixed; the guess of Guess::tied_to_lapse
  /// follows the lapse whatever its cells are. `counts` has at least one level.
  PosteriorGrid(Function function, Guess guess, const AxisCounts& counts, const Box& prior,
                double falling_share);

  Marginal marginal(Parameter parameter) const;
  /// Of the axis position where the probability is `p`; none where most of the posterior reaches it nowhere.
  std::optional<Marginal> marginal_of_crossing(double p) const;
  /// Of the probability at a position on the axis.
  Marginal marginal_of_probability(double u) const;

  /// Whether the data exclude neither end of the prior: under a flat one the density falls by less than the
  /// likelihood ratio that 95 % of ratios stay below. An interval would only repeat the prior.
  bool undetermined(Parameter parameter) const { return open_low(parameter) && open_high(parameter); }
  /// Whether they do not exclude one end: there the prior limits the parameter, not the data.
  bool open_low(Parameter parameter) const;
  bool open_high(Parameter parameter) const;

 private:
  struct Asymptotes {
    double low = 0, range = 1;  ///< guess, 1 - guess - lapse
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
  std::vector<Asymptotes> ends_;                 ///< [lapse][guess]
  std::vector<double> log_likelihood_;           ///< [threshold][rate][lapse][guess]
  std::vector<double> weight_, flat_;            ///< the same; with the prior, and under a flat one
};

}  // namespace turnpoint::analysis

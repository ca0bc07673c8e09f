#pragma once
#include <array>
#include <optional>
#include <vector>

#include "station/analysis/psychometric_fit.hpp"

namespace turnpoint::analysis {

/// Keeps logarithms finite if rounding makes a probability 0 or 1.
constexpr double kProbabilityFloor = 1e-12;

/// The parameters that the optimiser varies: threshold (as an axis_position()), ln rate, lapse, guess. A
/// parameter whose two bounds are equal is fixed. With Guess::tied_to_lapse, the guess equals the lapse.
using Theta = std::array<double, 4>;
struct ThetaBounds {
  Theta low{}, high{};
};

/// Numbers of trials and of positive answers at each level. `u` is the level's axis_position(). Only
/// `positive` differs between the replicates of a bootstrap.
struct AxisCounts {
  std::vector<double> u, trials, positive;  ///< `u` is ascending; u[0] may be kNoise
  /// Returns the lowest level with a signal.
  double lowest() const { return u.front() == kNoise && u.size() > 1 ? u[1] : u.front(); }
};

/// The likelihood of one set of counts and its maximum.
class Likelihood {
 public:
  /// With an `anchor`, theta[0] is the level at which the probability is `anchor`; without one, it is the
  /// threshold. Counts and bounds must outlive the object.
  Likelihood(Function function, Guess guess, const AxisCounts& counts, const ThetaBounds& bounds,
             std::optional<double> anchor = std::nullopt)
      : function_(function), guess_(guess), counts_(counts), bounds_(bounds), anchor_(anchor) {}

  double probability(const Theta& theta, double u) const { return probability(theta, anchor(theta), u); }
  double negative_log(const Theta& theta) const;

  struct Maximum {
    Theta theta{};
    double negative_log = 0;
  };
  /// Climbs from one start by Fisher scoring with Levenberg damping. A parameter that reaches a bound stays
  /// there as long as the gradient points outside.
  Maximum climb(Theta start) const;
  /// Searches a grid of starting points and climbs from the best of them, each with another threshold (if the
  /// threshold is held, with another rate).
  Maximum search() const;

 private:
  struct Local {
    double negative_log;
    std::array<double, 4> gradient;
    std::array<std::array<double, 4>, 4> information;
  };
  Local local(const Theta& theta) const;
  /// The value of the standard variable z (see sigmoid()) at the level theta[0], and its derivatives with
  /// respect to lapse and guess.
  struct Anchor {
    double z = 0, dz_dlapse = 0, dz_dguess = 0;
  };
  Anchor anchor(const Theta& theta) const;
  double probability(const Theta& theta, const Anchor& at, double u) const;
  std::array<double, 4> gradient_of_probability(const Theta& theta, const Anchor& at, double u) const;
  Maximum steepest(const Maximum& found) const;
  Theta project(Theta theta) const;

  Function function_;
  Guess guess_;
  const AxisCounts& counts_;
  const ThetaBounds& bounds_;
  std::optional<double> anchor_;
};

}  // namespace turnpoint::analysis

#pragma once
#include "station/core/draws.hpp"

namespace turnpoint::simulation {

/// Which boundary a diffusion (a random walk of evidence) reached, and when.
struct Passage {
  bool upper = false;  ///< true if the diffusion ended at the upper boundary
  double time_s = 0;
};

/// Draws the first passage of a Wiener process through -bound or +bound. The process has unit variance per
/// second, so `bound` (> 0) has the unit square root of a second, and `drift` one per square root of a
/// second. `start` is the starting point as a fraction of the bound, inside (-1, 1).
///
/// The result is exact, without time steps. If the walk starts in the middle between two boundaries, a time
/// is drawn from the inverse Gaussian distribution of the passage through one boundary (Michael, Schucany &
/// Haas 1976). It is accepted with a probability that follows from Feller's (1968) alternating series for two
/// boundaries. From any other start, the walk first leaves the largest interval around the start that fits
/// between the boundaries. The code uses only + - * / and square roots, so every machine draws the same
/// numbers.
Passage first_passage(double drift, double bound, double start, core::Draws& draws);

/// Returns the probability that a walk from the middle ends at the upper boundary: 1 / (1 + exp(-2 drift
/// bound)).
double upper_probability(double drift, double bound);

/// Returns the probability that a walk from the middle has ended at the upper boundary by `time_s`, or is
/// still between the boundaries and above the middle. It is 1/2 at time 0 and grows to upper_probability().
/// (Follows from the density of a walk between two absorbing boundaries as a sine series, Cox & Miller 1965,
/// section 5.7.)
double upper_by(double drift, double bound, double time_s);

/// Returns the probability that a walk ends at the upper boundary if its starting point is uniformly
/// distributed between -range and +range times the bound (0 <= range < 1).
double upper_probability(double drift, double bound, double range);

}  // namespace turnpoint::simulation

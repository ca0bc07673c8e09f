#pragma once
#include "station/random/draws.hpp"

namespace turnpoint::observer {

/// The end of a diffusion.
struct Passage {
  bool upper = false;  ///< true if it ended at the upper boundary
  double time_s = 0;
};

/// Draws the first passage through -bound or +bound of a Wiener process with unit variance per second (bound
/// > 0, in square roots of a second). `drift` is per square root of a second. `start` is the starting point
/// as a fraction of the bound, inside (-1, 1).
/// The result is exact, without a time step. From the middle of an interval, an inverse Gaussian variate
/// (Michael, Schucany & Haas 1976) is drawn for the passage through one boundary and accepted with the
/// probability that the alternating series of Feller (1968) gives for two boundaries. From any other start,
/// the walk first leaves the largest interval around it that fits between the boundaries. Only + - * / and
/// square roots are used, so every machine draws the same.
Passage first_passage(double drift, double bound, double start, random::Draws& draws);

/// The probability of ending at the upper boundary from the middle: 1 / (1 + exp(-2 drift bound)).
double upper_probability(double drift, double bound);

/// The same if the start is uniform between -range and +range times the bound (0 <= range < 1).
double upper_probability(double drift, double bound, double range);

}  // namespace turnpoint::observer

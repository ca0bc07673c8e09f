#pragma once
#include "station/random/draws.hpp"

namespace turnpoint::observer {

/// How a diffusion ended.
struct Passage {
  bool upper = false;  ///< at which of its two boundaries
  double time_s = 0;
};

/// Draws the first passage of a Wiener process of unit variance per second through -bound or +bound
/// (bound > 0, square root of seconds). `drift`: per square root of a second. `start`: where it begins, as a
/// share of the bound, inside (-1, 1).
///
/// Exact, without a time step: the passage from the middle of an interval is an inverse Gaussian variate
/// (Michael, Schucany & Haas 1976), which is longer than the passage through one of two boundaries exactly
/// as often as the alternating series of Feller (1968) says. From any other start the walk first leaves the
/// largest interval around it that fits between the boundaries. Only + - * / and square roots decide, so that
/// every machine draws the same.
Passage first_passage(double drift, double bound, double start, random::Draws& draws);

/// The probability of the upper boundary from the middle: 1 / (1 + exp(-2 drift bound)).
double upper_probability(double drift, double bound);

/// The same where the start is uniform between -range and +range times the bound (0 <= range < 1).
double upper_probability(double drift, double bound, double range);

}  // namespace turnpoint::observer

#pragma once
#include <cstdint>
#include <vector>

namespace reference {

/// Computes the posterior of a psychometric function by Metropolis sampling, from the formulas of the papers.
/// Shares only the random numbers with the station's code, not its grid.
enum class Shape { weibull_dB, normal };

struct Level {
  double level = 0;
  int trials = 0, positive = 0;
};

/// Sorts the levels and merges equal ones.
std::vector<Level> merged(std::vector<Level> levels);

/// A prior that is uniform in threshold, logarithm of the slope, lapse rate and guess rate; equal ends fix a
/// parameter. At both ends of their ranges, the density of the first two falls linearly to 0 over
/// `falling_share` of the range.
struct Prior {
  double threshold_low = 0, threshold_high = 1, slope_low = 1, slope_high = 2, lapse_low = 0, lapse_high = 0,
         guess_low = 0, guess_high = 0;
  bool guess_is_lapse = false;
  double falling_share = 0;
};

/// Random draws of the parameters, and of the level at which the probability is 0.75 (NaN if there is none).
struct Samples {
  std::vector<double> threshold, slope, lapse, guess, level_75;
};

/// Draws samples from the posterior: one in five of `steps` steps, after discarding a tenth as many at the
/// start. Step sizes range from a thousandth of the prior's range to all of it, so that narrow and wide
/// posteriors need no tuning.
Samples sample(Shape shape, const std::vector<Level>& data, const Prior& prior, int steps,
               std::uint64_t seed);

double quantile(std::vector<double> values, double p);
/// The share of values within [low, high].
double share_inside(const std::vector<double>& values, double low, double high);

}  // namespace reference

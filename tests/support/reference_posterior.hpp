#pragma once
#include <cstdint>
#include <vector>

namespace reference {

/// Computes the posterior of a psychometric function by Metropolis sampling, from the formulas of the papers.
/// Unlike the station, it uses no grid; it shares only the random numbers with the station's code.
enum class Shape { weibull_dB, normal };

struct Level {
  double level = 0;
  int trials = 0, positive = 0;
};

/// Sorts the levels and merges equal ones.
std::vector<Level> merged(std::vector<Level> levels);

/// A prior that is uniform in the threshold, the logarithm of the slope, the lapse rate and the guess rate.
/// If both ends of a range are equal, the parameter is fixed. For threshold and slope, the density falls
/// linearly to 0 over `falling_share` of the range at each end.
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

/// Draws samples from the posterior. It makes `steps` Metropolis steps, after a tenth as many that are
/// discarded, and keeps every fifth. Step sizes range from a thousandth of the prior's range to all of it, so
/// that they suit narrow and wide posteriors.
Samples sample(Shape shape, const std::vector<Level>& data, const Prior& prior, int steps,
               std::uint64_t seed);

double quantile(std::vector<double> values, double p);
/// Returns the share of values within [low, high].
double share_inside(const std::vector<double>& values, double low, double high);

}  // namespace reference

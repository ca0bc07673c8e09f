#pragma once
#include <optional>
#include <vector>

#include "station/analysis/estimate.hpp"

namespace turnpoint::analysis {

enum class Variances { equal, unequal };

/// The normal model of ratings: what is felt without a signal has mean 0 and standard deviation 1, with a
/// signal mean `mean` and standard deviation `sd`. A rating says between which two criteria it was.
struct RatingFit {
  double mean = 0;
  /// d', or with unequal variances d_a: the mean over the root mean square of both standard deviations, from
  /// which the area under the curve follows as Phi(d_a / sqrt 2)
  Estimate sensitivity;
  Estimate sd{1, {1, 1, 0.95}};
  Estimate area;                 ///< area under the smooth curve
  std::vector<double> criteria;  ///< ascending; ratings that were never given have none
  double log_likelihood = 0;     ///< without the multinomial coefficients
};

/// Fits the model by maximum likelihood (Dorfman & Alf 1969) to the numbers of noise and signal trials by
/// rating, from the surest "no" to the surest "yes". The 95 % intervals follow from the expected information.
/// Empty if the answers do not determine the parameters: no trials of one kind, ratings that separate both
/// kinds completely, or fewer than two criteria for unequal variances. Throws std::invalid_argument for lists
/// of different length or negative counts.
std::optional<RatingFit> fit_ratings(const std::vector<int>& noise, const std::vector<int>& signal,
                                     Variances variances);

}  // namespace turnpoint::analysis

#pragma once
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Distribution function and density of the standard normal.
double normal_cdf(double z);
double normal_density(double z);
/// Inverse of normal_cdf; throws std::invalid_argument outside (0, 1).
double normal_quantile(double p);

/// Score interval of a binomial proportion (Wilson 1927). Requires 0 <= successes <= trials, trials > 0, and
/// a confidence in (0, 1); otherwise throws std::invalid_argument.
Interval wilson(double successes, int trials, double confidence = 0.95);

/// The interval of Clopper & Pearson (1934). Its coverage is never below `confidence`. Arguments as for
/// wilson().
Interval clopper_pearson(double successes, int trials, double confidence = 0.95);

}  // namespace turnpoint::analysis

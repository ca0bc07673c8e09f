#pragma once
#include <vector>

#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// Returns a quantile by linear interpolation between order statistics (type 7 of Hyndman & Fan 1996).
/// `sorted` must be ascending and not empty, and p in [0, 1]; otherwise throws std::invalid_argument.
double sorted_quantile(const std::vector<double>& sorted, double p);

/// Like sorted_quantile(), for values in any order.
double quantile(std::vector<double> values, double p);

/// Returns the interval between two quantiles of bootstrap replicates. Equally many replicates lie below it
/// and above it.
Interval percentile_interval(std::vector<double> replicates, double confidence = 0.95);

/// The 97.5 % quantile of Student's t distribution with 1 degree of freedom or more, accurate to 0.8 %. An
/// estimate plus and minus this many standard errors is a 95 % interval.
double student_t_975(int degrees);

double mean(const std::vector<double>& values);  ///< arithmetic mean of at least one value
double variance(
    const std::vector<double>& values);  ///< sample variance (divisor n - 1) of at least two values

}  // namespace turnpoint::analysis

#pragma once
#include <optional>
#include <vector>

#include "station/analysis/estimate.hpp"

namespace turnpoint::analysis {

/// Estimates with 95 % intervals and p values by Student's t. Empty with fewer than 3 values.
std::optional<Estimate> student_mean(const std::vector<double>& values);
/// The mean of proportions, with an interval by Student's t on the logit scale (delta method), which stays
/// between 0 and 1 (Korn & Graubard 1998, Surv. Methodol. 24:193-201). If all values are 0, or all are 1, it
/// has no width. Empty with fewer than 3 values.
std::optional<Estimate> student_proportion(const std::vector<double>& values);
/// The difference of the means, a - b, of two samples that may differ in variance (Welch 1947). Empty if one
/// of the samples has fewer than 3 values, or if all values of both are equal.
std::optional<Estimate> student_difference(const std::vector<double>& a, const std::vector<double>& b);
/// The least-squares slope of y over x. Empty if all x are equal.
std::optional<Estimate> student_slope(const std::vector<double>& x, const std::vector<double>& y);

/// The ratio of the sums of y and x, such as points in a time, from pairs of them (linearised, with n - 1
/// degrees of freedom). Empty with fewer than 3 pairs, or if the x do not add up to more than 0.
std::optional<Estimate> student_ratio(const std::vector<double>& y, const std::vector<double>& x);

}  // namespace turnpoint::analysis

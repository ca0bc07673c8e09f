#pragma once
#include <span>

namespace turnpoint::core {

// Logarithm and exponential that use only + - * /, so that decisions based on them are the same on every
// machine. (The results of libm differ between versions and with fused multiply-add.) Relative error below
// 4e-16.

/// Natural logarithm of a positive, finite number; throws std::domain_error otherwise.
double log(double x);

/// Stores the logarithm of each number, with the same bits as log(). This takes about a tenth of the time.
/// `results` must be at least as long as `x` and must not overlap it. Throws std::domain_error if a number
/// has no logarithm; the results then mean nothing.
void logs(std::span<const double> x, std::span<double> results);

/// e to the power x. Returns 0 for x below -745; throws std::domain_error for x above 709 or NaN.
double exp(double x);

/// Standard normal distribution function, with an absolute error of 1e-15. Returns exactly 0 or 1 for |x|
/// above 8.
double normal_cdf(double x);

}  // namespace turnpoint::core

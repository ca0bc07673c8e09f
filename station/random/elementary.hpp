#pragma once

namespace turnpoint::random {

// Logarithm and exponential that use only + - * /, so that decisions based on them are the same on every
// machine. (The results of libm differ between versions and with fused multiply-add.) Relative error below
// 4e-16.

/// Natural logarithm of a positive, finite number; throws std::domain_error otherwise.
double log(double x);

/// e to the power x. Returns 0 for x below -745; throws std::domain_error for x above 709 or NaN.
double exp(double x);

/// Standard normal distribution function, with an absolute error of 1e-15. Returns exactly 0 or 1 for |x|
/// above 8.
double normal_cdf(double x);

}  // namespace turnpoint::random

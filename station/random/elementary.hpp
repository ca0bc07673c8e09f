#pragma once

namespace turnpoint::random {

// Logarithm and exponential that use only + - * /, so that decisions based on them are the same on every
// machine. Those of libm differ between versions and with fused multiply-add. Relative error below 4e-16.

/// Natural logarithm of a positive, finite number; throws std::domain_error otherwise.
double log(double x);

/// e to the x. Returns 0 below -745; throws std::domain_error above 709 or for NaN.
double exp(double x);

/// Standard normal distribution function, with an absolute error of 1e-15 (beyond 8 it is 0 or 1).
double normal_cdf(double x);

}  // namespace turnpoint::random

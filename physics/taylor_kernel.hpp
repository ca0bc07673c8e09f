#pragma once
// The inner loops of a profile: many points of one Taylor polynomial. Plain loops that vectorise, compiled
// for several instruction sets and chosen when the program starts; without fused multiply-add all give equal
// bits.
#include <complex>
#include <cstddef>

namespace turnpoint::physics {

inline constexpr int taylor_order = 32;

// Coefficients of sum c_n tau^n, n = 0 ... taylor_order, real and imaginary parts.
struct TaylorStep {
  double x_start;   // outer end (m); tau = (x_start - x) / scale
  double scale;     // m
  double length;    // the step covers x_start - length ... x_start
  double ln_scale;  // of the coefficients
  double re[taylor_order + 1];
  double im[taylor_order + 1];
};

// How a displacement follows from g: v = g W^-1/2 (or g), W = w0 + tau w1 + ... is passed per point.
void horner_real(const TaylorStep& step, const double* x, std::size_t n, double* re);
void horner_complex(const TaylorStep& step, const double* x, std::size_t n, double* re, double* im);

// 0.5 ln(re^2 + im^2) + offset, absolute error below 1e-15 of 1 + |ln|; arguments of normal size.
void half_log_square(const double* re, const double* im, std::size_t n, double offset, double* out);

}  // namespace turnpoint::physics

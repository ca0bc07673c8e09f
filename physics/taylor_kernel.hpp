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

// Values of the polynomial at n points.
void horner_real(const TaylorStep& step, const double* x, std::size_t n, double* re);
void horner_complex(const TaylorStep& step, const double* x, std::size_t n, double* re, double* im);

// Multiplies by (half_width - slope x)^-1/2.
void divide_by_root_width(double half_width, double slope, const double* x, std::size_t n, double* re,
                          double* im);

// out[2 i], out[2 i + 1] = (re + i im)(factor_re + i factor_im).
void rotate(const double* re, const double* im, std::size_t n, double factor_re, double factor_im,
            double* out);

// 0.5 ln(re^2 + im^2) + offset, absolute error below 1e-15 of 1 + |ln|; returns whether all squares were
// above 1e-289, as that takes.
bool half_log_square(const double* re, const double* im, std::size_t n, double offset, double* out);

}  // namespace turnpoint::physics

#pragma once
// The inner loops of a profile, which evaluate one Taylor polynomial at many points. They are plain loops
// that the compiler vectorises for several instruction sets; the program chooses the best version when it
// starts. All versions that do not use fused multiply-add give the same bits.
#include <complex>
#include <cstddef>

namespace turnpoint::physics {

inline constexpr int taylor_order = 32;

// One step of the solution: the coefficients of sum c_n tau^n, n = 0 ... taylor_order, with real and
// imaginary parts.
struct TaylorStep {
  double x_start;   // outer end of the step (m); tau = (x_start - x) / scale
  double scale;     // length in m that corresponds to tau = 1
  double length;    // the step covers x_start - length ... x_start
  double ln_scale;  // logarithm of the factor that multiplies the coefficients
  double re[taylor_order + 1];
  double im[taylor_order + 1];
  int order = taylor_order;  // index of the last coefficient that is not negligible
};

// Evaluates the step's polynomial at n points.
void horner_real(const TaylorStep& step, const double* x, std::size_t n, double* re);
void horner_complex(const TaylorStep& step, const double* x, std::size_t n, double* re, double* im);

// Divides the values by the root of the half-width, (half_width - slope x)^1/2.
void divide_by_root_width(double half_width, double slope, const double* x, std::size_t n, double* re,
                          double* im);

// Multiplies by a complex factor: out[2 i], out[2 i + 1] = (re + i im)(factor_re + i factor_im).
void rotate(const double* re, const double* im, std::size_t n, double factor_re, double factor_im,
            double* out);

// Computes 0.5 ln(re^2 + im^2) + offset with an absolute error below 1e-15 (1 + |ln|). Returns false if re^2
// + im^2 is 1e-289 or less at some point; the result at this point is then not valid.
bool half_log_square(const double* re, const double* im, std::size_t n, double offset, double* out);

// Computes the magnitudes of n complex numbers, given as pairs of real and imaginary part. Like std::abs(),
// it scales them first so that their squares neither overflow nor underflow. A magnitude below 1e-307 becomes
// 0.
void magnitudes(const double* pairs, std::size_t n, double* out);

}  // namespace turnpoint::physics

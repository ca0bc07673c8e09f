#pragma once
#include <cstddef>
#include <cstdint>

/// The inner loops over captured samples. Every processor gives the same bits: each sum adds its terms in the
/// same order everywhere, and no multiplication is fused with an addition.
namespace turnpoint::sensing::loops {

/// The number of columns that tones() works on.
inline constexpr std::size_t kTones = 8;

/// Reads `count` samples that are `stride` apart, and writes them as numbers with full scale 1.
void scale(const std::int32_t* samples, std::ptrdiff_t stride, std::int64_t count, double* to) noexcept;
/// y(n) = (2 s(n) - s(n - step) - s(n + step)) / 4; `s` has `step` more samples on both sides.
void high_pass(const double* s, int frames, int step, double* y) noexcept;
/// Sum of squares.
double energy(const double* y, int frames) noexcept;
/// Largest absolute value; NaN is skipped.
double largest(const double* s, int frames) noexcept;

/// Sums and differences of mirrored samples: with x = s + half, even[n] = x[n] + x[-1 - n] and
/// odd[n] = x[n] - x[-1 - n], for n < half.
void fold(const double* s, std::size_t half, double* even, double* odd) noexcept;
/// Multiplies each row of x with kTones columns of a table and sums over the frames: sums[i * columns + k]
/// = sum over n of x[i * frames + n] * table[n * columns + k]. `inputs` is the number of rows.
void tones(const double* x, std::size_t inputs, std::size_t frames, const double* table, std::size_t columns,
           double* sums) noexcept;

/// Converts the captured frames to floats: four of their channels, `stride` samples from frame to frame.
void pick_four(const std::int32_t* frames, std::int64_t count, const int* channels, std::ptrdiff_t stride,
               float* to) noexcept;
/// A symmetric filter for four signals at once, mixed down with a carrier whose cosine and sine the taps
/// contain. `middle` is the sample in the middle, with `half` more on both sides. re = sum over n = 0 ...
/// half of (x[n] + x[-n]) even[n]; im = sum of (x[n] - x[-n]) odd[n]. Samples and taps are groups of four
/// floats; a tap is repeated four times.
void carrier(const float* middle, std::int64_t half, const float* even, const float* odd, float* re,
             float* im) noexcept;
/// A symmetric filter for eight signals at once, with taps[n] for the samples x[n] and x[-n] of
/// `middle`, n = 0 ... half. taps[0] must be half of the middle tap.
void eight(const double* middle, std::int64_t half, const double* taps, double* sums) noexcept;

}  // namespace turnpoint::sensing::loops

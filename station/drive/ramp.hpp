#pragma once
#include "station/drive/burst.hpp"
#include "station/drive/sine.hpp"

namespace turnpoint::drive {

/// The rise of a ramp: 0 at u = 0, 1 at u = 1, symmetric about (1/2, 1/2); constant outside.
inline double ramp_gain(RampShape shape, double u) noexcept {
  if (!(u > 0)) return 0;
  if (u >= 1) return 1;
  if (shape == RampShape::raised_cosine) {
    const double s = sine_of_quarter(u * 0.25);
    return s * s;
  }
  const double u2 = u * u;
  return u2 * u2 * (35 + u * (-84 + u * (70 - 20 * u)));
}

/// Gain of frame `n` of a rise of `frames`, sampled at half frames so that a fall is its mirror image.
inline double ramp_at(RampShape shape, std::int64_t n, std::int64_t frames) noexcept {
  if (n >= frames) return 1;
  return ramp_gain(shape, (static_cast<double>(n) + 0.5) / static_cast<double>(frames));
}

}  // namespace turnpoint::drive

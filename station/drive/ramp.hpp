#pragma once
#include <cstdint>
#include "station/drive/burst.hpp"
#include "station/drive/sine.hpp"

namespace turnpoint::drive {

/// Gain of a rising ramp at the fraction u of its length. It rises from 0 at u = 0 to 1 at u = 1, is
/// symmetric about (1/2, 1/2), and is constant outside this range.
inline double ramp_gain(double u) noexcept {
  if (!(u > 0)) return 0;
  if (u >= 1) return 1;
  const double s = sine_of_quarter(u * 0.25);
  return s * s;
}

/// Gain of frame `n` of a rising ramp with `frames` frames. It is computed for the middle of the frame, so
/// that a falling ramp is the exact mirror image of a rising one.
inline double ramp_at(std::int64_t n, std::int64_t frames) noexcept {
  if (n >= frames) return 1;
  return ramp_gain((static_cast<double>(n) + 0.5) / static_cast<double>(frames));
}

}  // namespace turnpoint::drive

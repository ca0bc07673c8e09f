#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "station/sensing/strokes.hpp"

namespace turnpoint::sensing {

/// Stretches of equal length along the strip.
struct Bins {
  double from_mm = 0, width_mm = 2;
  std::size_t count = 0;

  double centre_mm(std::size_t i) const { return from_mm + (static_cast<double>(i) + 0.5) * width_mm; }
};

/// Friction in each bin during one stroke: the sum of |T| over the sum of N, because a mean of quotients
/// would give weight to moments with little force. NaN where the finger was not, or pressed with less than
/// least_normal_N.
struct StrokeFriction {
  int direction = 0;
  std::vector<double> friction;
};

/// Mean over strokes in one direction; NaN without strokes. The standard error is NaN for fewer than two.
struct MeanFriction {
  std::vector<double> friction, se;
};

struct FrictionProfile {
  Bins bins;
  std::vector<StrokeFriction> strokes;

  MeanFriction mean(int direction) const;
};

FrictionProfile friction_profile(std::span<const FingerPoint> track, std::span<const Stroke> strokes,
                                 const Bins& bins);

/// Friction of one stroke as a whole: the sum of |T| over the sum of N. NaN if nothing of it counts.
double stroke_friction(std::span<const FingerPoint> track, const Stroke& stroke);

}  // namespace turnpoint::sensing

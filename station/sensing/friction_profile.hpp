#pragma once
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "station/sensing/finger_track.hpp"

namespace turnpoint::sensing {

/// Divides the strip into bins of equal length.
struct Bins {
  double from_mm = 0, width_mm = 2;
  std::size_t count = 0;

  double centre_mm(std::size_t i) const { return from_mm + (static_cast<double>(i) + 0.5) * width_mm; }
};

/// Friction in each bin during one stroke: the sum of |lateral force| over the sum of normal force. (A mean
/// of quotients would give too much weight to times of little force.) NaN in bins where the finger was not,
/// or pressed with less than least_normal_N.
struct StrokeFriction {
  int direction = 0;
  std::vector<double> friction;
};

/// Mean friction and standard error in each bin, over the strokes in one direction. The mean is NaN if there
/// is no stroke; the standard error is NaN if there are fewer than two.
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

/// A part of the strip, in mm from the wide edge.
struct StripPart {
  double from_mm = 0, to_mm = std::numeric_limits<double>::infinity();
};

/// Mean friction over all the given strokes, within a part of the strip: the sum of |lateral force| over the
/// sum of normal force. Only points with contact and a normal force of least_normal_N or more count; NaN if
/// there are none.
double mean_friction(std::span<const FingerPoint> track, std::span<const Stroke> strokes,
                     const StripPart& part = {});

}  // namespace turnpoint::sensing

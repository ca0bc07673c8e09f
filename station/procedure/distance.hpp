#pragma once
#include "station/core/elementary.hpp"
#include "station/procedure/spec.hpp"

namespace turnpoint::procedure {

/// Represents an infinite distance. Distances between finite levels are always smaller.
constexpr double kBeyond = 1e300;

/// Returns the distance of a stimulus above a threshold: the difference of their levels on a linear scale,
/// the logarithm of their ratio on a logarithmic scale.
inline double distance(Scale scale, double level, double threshold) {
  if (scale == Scale::linear) return level - threshold;
  if (level <= 0) return -kBeyond;
  return threshold <= 0 ? kBeyond : core::log(level / threshold);
}

}  // namespace turnpoint::procedure

#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "physics/friction.hpp"
#include "station/analysis/quantile.hpp"

namespace turnpoint::sensing {

/// One stroke over the vibrating surface, or over the surface at rest (displacement 0).
struct TableStroke {
  double displacement_m = 0;  ///< peak displacement under the finger
  double friction = 0;        ///< coefficient of friction; NaN if the stroke is not valid
};

/// Friction at one displacement, relative to friction on the surface at rest.
struct FrictionLevel {
  double displacement_m = 0;
  int strokes = 0;
  double measured = 1;           ///< geometric mean of the strokes' friction relative to that at rest
  double relative_friction = 1;  ///< `measured` after a monotone regression, so it falls from level to level
  double sd = 0;                 ///< standard error of relative_friction
  analysis::Interval interval;   ///< 95 % interval of relative_friction
};

struct FrictionTable {
  std::vector<FrictionLevel> levels;  ///< all levels, in ascending order of displacement
  /// Displacement that halves friction; empty if no level reduces friction that far.
  std::optional<double> half_displacement_m;
  double half_displacement_sd_m = 0;
  analysis::Interval half_displacement_interval;
  /// number of strokes over the vibrating surface that were left out, because they are not valid or have no
  /// valid neighbour over the surface at rest
  int unused = 0;

  /// The table in the form that a rig uses. It begins with relative friction 1 at displacement 0.
  std::vector<physics::FrictionPoint> points() const;
};

/// Estimates the friction table from strokes in the order in which they were made. Friction of skin drifts by
/// tens of per cent within minutes, so each stroke over the vibrating surface is compared with the strokes at
/// rest before and after it: its value is the logarithm of friction, minus the mean logarithm of those two.
/// The means of the levels go through a monotone regression (pool adjacent violators) and are joined by
/// monotone cubics. (A curve with few parameters would be wrong where friction no longer falls.) Standard
/// errors and intervals come from a bootstrap over the strokes of each level, widened to allow for the small
/// number of strokes. Throws core::UsageError if a level has fewer than three usable strokes or if there are
/// no levels.
FrictionTable friction_table(std::span<const TableStroke> strokes, std::uint64_t seed, int replicates = 1000);

}  // namespace turnpoint::sensing

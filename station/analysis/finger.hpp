#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/analysis/trial_record.hpp"

namespace turnpoint::analysis {

/// What force cells measured of the finger in one trial. Values that were not measured are empty.
struct FingerTrial {
  int trial_index = 0;
  std::string condition;                       ///< condition of the trial; "" if there is only one
  bool measured = false;                       ///< whether the forces of this trial are known
  std::optional<double> normal_N, speed_mm_s;  ///< means over the strokes of the finger in this trial
  std::optional<double> mu_low, mu_high;  ///< friction on the smooth and the rough side of the felt boundary
  /// For the scene presented last: the planned position of the change of friction, the position at which the
  /// finger met the change, and the standard error of that position.
  std::optional<double> planned_mm, felt_mm, felt_se_mm;
};

/// The finger in the trials of one condition. Estimates are means over trials, with 95 % intervals by
/// Student's t; empty with fewer than 3 trials that have the value.
struct FingerCondition {
  std::string condition;
  int trials = 0;    ///< number of trials in which force cells recorded
  int measured = 0;  ///< number of trials whose forces are known
  int felt = 0;      ///< number of trials in which the forces show where the finger met the boundary
  std::optional<Estimate> normal_N, speed_mm_s, mu_low, mu_high;
  std::optional<Estimate> shift_mm;  ///< position of the felt boundary minus the planned position
};

/// The mean of a quantity over the trials with the same planned boundary, with its interval if that is known.
struct AtBoundary {
  double planned_mm = 0, value = 0;
  int trials = 1;  ///< number of trials of which `value` is the mean
  std::optional<Interval> interval;
};

/// The felt boundary and the friction on both sides of it, for each planned boundary. If 3 or more trials
/// share a planned boundary (to 0.1 mm), their values are averaged, with an interval by Student's t.
/// Otherwise each trial keeps its own value; the interval of a felt boundary is then 1.96 standard errors of
/// the trial to both sides.
struct FeltBoundaries {
  std::vector<AtBoundary> shift_mm, mu_low, mu_high;  ///< in ascending order of the planned boundary
};

/// Friction in one direction of movement, by distance from the planned boundary: means and standard errors
/// over strokes, where there are 3 or more.
struct FrictionCurve {
  std::string direction;  ///< "towards the narrow end" or "towards the wide end"
  std::vector<double> from_boundary_mm, friction, se;
  bool narrow = true;  ///< true if the direction is that towards the narrow end
};

/// How many of the trials presented at a level were presented again because of the finger's movement.
struct RepeatedTrials {
  std::optional<double> level;
  int presented = 0, repeated = 0;
};

struct Finger {
  std::vector<FingerTrial> trials;  ///< in the order in which they were passed in
  /// one for each condition; those in the argument `order` of finger() come first
  std::vector<FingerCondition> conditions;
  FeltBoundaries boundaries;  ///< boundaries of all conditions
  std::vector<Statement> statements;
};

/// Summarises trials in which force cells recorded. Empty if there are none.
std::optional<Finger> finger(const std::vector<FingerTrial>& trials, const std::vector<std::string>& order);

}  // namespace turnpoint::analysis

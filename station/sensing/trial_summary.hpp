#pragma once
#include <limits>
#include <span>

#include "station/sensing/strokes.hpp"

namespace turnpoint::sensing {

/// The movement that the participant is asked to make.
struct MovementWindow {
  static constexpr double any = std::numeric_limits<double>::infinity();

  double least_normal_N = 0, most_normal_N = any;      ///< allowed normal force, ends included
  double least_speed_mm_s = 0, most_speed_mm_s = any;  ///< allowed speed, ends included
  double fraction = 0.8;  ///< required fraction of the strokes' time with force and speed in range
  int strokes = 0;        ///< least number of strokes in a trial
};

/// Whether the participant moved as asked. If a movement has several faults, the first in this list is given.
enum class Movement {
  ok,
  strokes,  ///< too few strokes
  light,    ///< too little normal force
  hard,     ///< too much normal force
  slow,
  fast,
};
const char* name(Movement movement);

/// What the finger did during one trial. Quantities that could not be measured are NaN.
struct TrialSummary {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  double contact_s = 0;
  int strokes = 0;
  /// Mean and standard deviation of normal force over all strokes.
  double normal_N = none, normal_sd_N = none;
  /// fraction of the strokes' time with normal force in the window; NaN if any force is allowed
  double normal_in_window = none;
  double speed_mm_s = none;  ///< mean absolute speed over all strokes
  /// fraction of the strokes' time with speed in the window; NaN if any speed is allowed
  double speed_in_window = none;
};

/// Summarises the forces and the movement of the finger in one trial.
TrialSummary summarise(std::span<const FingerPoint> track, Band band, std::span<const Stroke> strokes,
                       const MovementWindow& window);

Movement judge(const TrialSummary& summary, const MovementWindow& window);

}  // namespace turnpoint::sensing

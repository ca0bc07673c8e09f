#pragma once
#include <optional>
#include <string>
#include <vector>

#include "station/analysis/estimate.hpp"
#include "station/core/records.hpp"

namespace turnpoint::analysis {

// Scenes that follow the finger: what friction they asked for, and what the finger felt.

/// What one trial recorded about following, in the interval presented last.
struct FollowedTrial {
  int trial_index = 0;
  std::string condition;  ///< condition of the trial; "" if there is only one
  core::FollowRow follow;
};

/// Following in the trials of one condition: means over trials with 95 % intervals by Student's t (of shares
/// on the logit scale); empty with fewer than 3 trials that have the value.
struct FollowedCondition {
  std::string condition;
  int trials = 0;
  int faultless = 0;  ///< trials in which no fault interrupted following
  std::optional<Estimate> mu_asked, mu_commanded, mu_felt;
  std::optional<Estimate> lag_ms, inside, share, envelope_error_dB, envelope_lag_us;
};

/// One measurement of friction under the sliding finger, and what was asked and commanded at its place and
/// time. All are coefficients of friction.
struct FollowedPoint {
  double place_mm = 0;  ///< from the wide end
  bool narrow = true;   ///< the finger moves towards the narrow end
  double asked = 0, commanded = 0, felt = 0;
};

/// The points of one interval of a trial.
struct FollowedPath {
  std::string condition, scene;
  std::vector<FollowedPoint> points;
};

/// The median of intervals at one place, and their quartiles.
struct Spread {
  double median = 0, low = 0, high = 0;
};

/// Friction over place in one direction of movement, of all intervals with one scene in one condition.
struct FollowedPlaces {
  std::string condition, scene;
  bool narrow = true;
  std::vector<double> place_mm;  ///< middles of the bins, ascending
  std::vector<Spread> asked, commanded, felt;
  std::vector<Spread> deviation;  ///< felt minus asked as a share of asked, computed in each interval
};

inline constexpr double kFollowedBin_mm = 1;
/// Bins in which fewer intervals have values than this are left out.
inline constexpr int kFewestFollowed = 3;

/// Each interval counts once in a bin, with the mean of its points there, however slow or often the finger
/// was there. Sorted by condition and scene as they come first, towards the narrow end before the other
/// direction.
std::vector<FollowedPlaces> friction_over_place(const std::vector<FollowedPath>& paths);

/// The conditions in which scenes followed the finger; those in `order` first.
std::vector<FollowedCondition> followed(const std::vector<FollowedTrial>& trials,
                                        const std::vector<std::string>& order);

}  // namespace turnpoint::analysis

#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <type_traits>

#include "station/follow/follower.hpp"

namespace turnpoint::follow {

/// One update of an interval of a trial, as it was made.
struct Recorded {
  std::int32_t interval = 0;
  std::int64_t frame = 0;         ///< first playback frame of the period for which it gives the gains
  std::int64_t sample_frame = 0;  ///< playback frame at which the forces were measured
  Update update;
};
static_assert(std::is_trivially_copyable_v<Recorded>);

/// Felt friction is inside the tolerance if it differs from what was asked by less than this share of it.
inline constexpr double kTolerance = 0.1;

/// What one interval presented and what the finger felt, over the times at which the surface followed the
/// finger and the finger slid, so that friction was felt. Empty if there were none.
struct Summary {
  std::optional<double> asked;  ///< mean coefficient of friction; empty if a displacement was asked for
  /// Mean by the friction table and the modelled envelope; empty if a displacement was asked for and the
  /// friction at rest is not known.
  std::optional<double> commanded;
  std::optional<double> felt;  ///< mean as measured
  /// By how much felt friction is behind what was asked at the finger, by the largest correlation. Empty if
  /// what was asked varied by less than 5 % of its mean (standard deviation).
  std::optional<double> lag_s;
  std::optional<double> inside;  ///< share of the times at which felt friction was inside kTolerance
  double share = 0;              ///< share of the interval in which the surface followed the finger
};
/// If the plan does not know the friction at rest, it is the one with which `commanded` equals `felt`, so
/// that `inside` says how friction varied and not how high it was. `periods` are those of one interval, in
/// order, of which only the times from `first_frame` to before `end_frame` count. Periods that were left out
/// are allowed.
Summary summarise(std::span<const Recorded> periods, const Plan& plan, std::int64_t first_frame,
                  std::int64_t end_frame);

/// Names of all faults that have interrupted following, with spaces between them, in the order of Fault; also
/// those of late, reference and force that were seen at rest. "ok" if there are none. `late`: gains came too
/// late to be played.
std::string fault_names(std::span<const Recorded> periods, bool late);

}  // namespace turnpoint::follow

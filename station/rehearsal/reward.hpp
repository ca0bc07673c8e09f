#pragma once
#include <map>
#include <string>
#include <vector>

#include "station/protocol/protocol.hpp"
#include "station/rehearsal/power.hpp"

namespace turnpoint::rehearsal {

/// What the decision boundaries of the diffusion earn in one block.
struct Trade {
  double points_per_minute = 0;
  double right = 0;            ///< proportion correct of the answers that are right or wrong
  double response_time_s = 0;  ///< mean
};

/// The boundaries with which an observer earns the most points per minute in one block (Bogacz, Brown,
/// Moehlis, Holmes & Cohen 2006, Psychol. Rev. 113, 700).
struct BestReward {
  std::string block;   ///< block_labels()
  double caution = 1;  ///< how many times as far apart as Parameters::bound says (simulation::Question)
  /// The best boundaries are not within the range of kLeastCaution to kMostCaution, so `caution` is its end:
  /// it pays to guess at once, or nothing is lost by waiting.
  bool at_end = false;
  Trade best;
  Trade own;  ///< with the observer's own boundaries, which depend on the deadline
};

inline constexpr double kLeastCaution = 0.1, kMostCaution = 4;

/// Finds the best boundaries for each block with points, practice left out, by simulating whole sessions of
/// options.observer with equal seeds and different boundaries. Depends on nothing but the protocol, the
/// observer and the seed. Points per minute change little around the best caution, so that it is known to
/// about a tenth only. Empty if a stop is requested. Throws core::UsageError if the protocol gives no points,
/// or if its answers do not depend on boundaries.
std::vector<BestReward> best_rewards(const protocol::Protocol& protocol, const PowerOptions& options);

/// The same as PowerOptions::cautions.
std::map<std::string, double> cautions_of(const std::vector<BestReward>& rewards);

}  // namespace turnpoint::rehearsal

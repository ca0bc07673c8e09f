#pragma once
#include <array>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::simulation {

/// The values of one cue in the intervals of a trial, the right answer, and how often this occurs. `x` has
/// one number for each interval, at most three.
struct Look {
  std::array<double, 3> x{};
  int correct = 0;
  double weight = 1;
};

/// How an observer derives an answer from one cue.
enum class Statistic {
  value,   ///< one interval: one answer if the cue lies inside a band, the other answer outside
  change,  ///< same or different: like `value`, with the difference between the two intervals
  most,    ///< which interval: the one with the largest cue
  least,   ///< ... with the smallest
  odd,     ///< ... with the one that differs most from the other intervals or, of two, from `usual`
  even,    ///< ... with the one that differs least
};

/// Which differences count as none. Two intervals are compared by `relative`, a share of the larger value,
/// unless it is 0. A band of values over all trials may end only where values are further apart than
/// `absolute`.
struct Grain {
  double absolute = 0, relative = 0;
};

struct Rule {
  Statistic statistic = Statistic::value;
  double low = 0, high = 0;  ///< the band: from low (inclusive) to high; may extend to infinity
  int inside = 0;
  double usual = 0;  ///< mean cue of the intervals that should not be chosen
  Grain grain = {};
};

/// The probability that this observer gives each answer; between intervals with equal cues it guesses.
std::array<double, 3> shares(const Rule& rule, protocol::TaskKind task, const std::array<double, 3>& x);

/// The proportion correct over these looks; 0 if there are none.
double accuracy(const Rule& rule, protocol::TaskKind task, const std::vector<Look>& looks);

/// The rule with the highest proportion correct over these looks.
Rule best_rule(protocol::TaskKind task, const std::vector<Look>& looks, const Grain& grain);

}  // namespace turnpoint::simulation

#pragma once
#include <array>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::simulation {

/// What one cue shows in the intervals of one trial, which answer is right, and how often this happens. `x`
/// has one number for each interval, at most three.
struct Look {
  std::array<double, 3> x{};
  int correct = 0;
  double weight = 1;
};

/// How an observer turns what one cue shows into an answer.
enum class Statistic {
  value,   ///< one interval: an answer where the cue lies inside a band, the other answer elsewhere
  change,  ///< same or different: the same with the distance of the two intervals
  most,    ///< which interval: the one with the largest cue
  least,   ///< ... with the smallest
  odd,     ///< ... with the one most unlike the other intervals or, of two, most unlike `usual`
  even,    ///< ... with the one most like them
};

/// Which differences are none. Two intervals are compared by `relative` where that is not 0: a share of the
/// larger; bands of values over all trials end only where the values lie further apart than `absolute`.
struct Grain {
  double absolute = 0, relative = 0;
};

struct Rule {
  Statistic statistic = Statistic::value;
  double low = 0, high = 0;  ///< the band: from low (inclusive) to high; it may be open to infinity
  int inside = 0;
  double usual = 0;  ///< mean cue of the intervals that are not to be chosen
  Grain grain = {};
};

/// The probability that this observer gives each answer; where intervals show the same it guesses.
std::array<double, 3> shares(const Rule& rule, protocol::TaskKind task, const std::array<double, 3>& x);

/// The proportion right over these looks. Without looks: 0.
double accuracy(const Rule& rule, protocol::TaskKind task, const std::vector<Look>& looks);

/// The rule with the highest proportion right over these looks.
Rule best_rule(protocol::TaskKind task, const std::vector<Look>& looks, const Grain& grain);

}  // namespace turnpoint::simulation

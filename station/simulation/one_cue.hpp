#pragma once
#include <array>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::simulation {

/// The values of one cue in the intervals of a trial, the right answer, and the weight of such trials in an
/// average. `x` has one value per interval, at most three.
struct Look {
  std::array<double, 3> x{};
  int correct = 0;
  double weight = 1;
};

/// How an observer derives an answer from the values of one cue.
enum class Statistic {
  /// one interval: the observer gives one answer if the cue lies inside a band, and the other answer
  /// otherwise
  value,
  change,  ///< same or different: like `value`, applied to the difference between the two intervals
  most,    ///< which interval: the observer chooses the interval with the largest cue
  least,   ///< which interval: the observer chooses the interval with the smallest cue
  /// which interval: the observer chooses the interval that differs most from the other intervals; of two
  /// intervals, the one that differs most from `usual`
  odd,
  even,  ///< which interval: the observer chooses the interval that differs least (see `odd`)
};

/// Resolution for cue values: values that differ by less count as equal. To compare two intervals, `relative`
/// (a fraction of the larger value) is used, or `absolute` if `relative` is 0. A band may end only between
/// two neighbouring values, of all trials, that differ by more than `absolute`.
struct Grain {
  double absolute = 0, relative = 0;
};

struct Rule {
  Statistic statistic = Statistic::value;
  double low = 0, high = 0;  ///< the band: from low (inclusive) to high; may extend to infinity
  int inside = 0;
  double usual = 0;  ///< mean cue of the intervals that are wrong answers
  Grain grain = {};
};

/// The probability of each answer from an observer with this rule. Between intervals with equal cues, the
/// observer guesses.
std::array<double, 3> shares(const Rule& rule, protocol::TaskKind task, const std::array<double, 3>& x);

/// The proportion correct over these looks; 0 if there are none.
double accuracy(const Rule& rule, protocol::TaskKind task, const std::vector<Look>& looks);

/// The rule with the highest proportion correct over these looks.
Rule best_rule(protocol::TaskKind task, const std::vector<Look>& looks, const Grain& grain);

}  // namespace turnpoint::simulation

#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "station/protocol/protocol.hpp"

namespace turnpoint::rehearsal {

constexpr std::size_t most_intervals = 4;
using CueValues = std::array<double, most_intervals>;
using Shares = std::array<double, protocol::most_choices>;

/// The values of one cue in the intervals of a trial, the right answer, and the weight of such trials in an
/// average. `x` has one value per interval.
struct Look {
  CueValues x{};
  int correct = 0;
  double weight = 1;
};

/// What the task asks the observer to decide.
struct Asked {
  protocol::TaskKind kind = protocol::TaskKind::single_interval;
  std::size_t intervals = 1, answers = 2;
};
Asked asked_by(const protocol::Task& task);

/// How an observer derives an answer from the values of one cue.
enum class Statistic {
  value,   ///< one interval: the range of values in which the cue lies decides
  change,  ///< same or different: like `value`, applied to the difference between the two intervals
  most,    ///< which interval: the observer chooses the interval with the largest cue
  least,   ///< which interval: the observer chooses the interval with the smallest cue
  /// which interval: the observer chooses the interval that differs most from the other intervals; of two
  /// intervals, the one that differs most from `usual`
  odd,
  even,      ///< which interval: the observer chooses the interval that differs least (see `odd`)
  nearest,   ///< ABX and match-to-sample: the observer chooses the interval that is most like X
  farthest,  ///< ABX and match-to-sample: the observer chooses the interval that is least like X
};

/// Resolution for cue values: values that differ by less count as equal. To compare two intervals, `relative`
/// (a fraction of the larger value) is used, or `absolute` if `relative` is 0. A range may end only between
/// two neighbouring values, of all trials, that differ by more than `absolute`.
struct Grain {
  double absolute = 0, relative = 0;
};

/// The answer that an observer gives if the cue is below `end` and not in an earlier range.
struct CueRange {
  double end = 0;  ///< upper end of the range; infinity for the last range
  int answer = 0;
  bool operator==(const CueRange&) const = default;
};

struct Rule {
  Statistic statistic = Statistic::value;
  /// for `value` and `change`, in ascending order: at most one range more than there are answers. With two
  /// answers, two ranges are a criterion, and three are a band.
  std::vector<CueRange> ranges;
  double usual = 0;  ///< mean value of the cue in the intervals that are wrong answers
  Grain grain = {};
};

/// The probability of each answer from an observer with this rule. Between intervals with equal cues, the
/// observer guesses.
Shares shares(const Rule& rule, const Asked& asked, const CueValues& x);

/// Returns the proportion correct of an observer who uses `rule` in the trials `looks`; 0 if there are none.
double accuracy(const Rule& rule, const Asked& asked, const std::vector<Look>& looks);

/// Weights the trials so that each answer is right equally often.
void weight_by_answer(std::vector<Look>& looks);

/// The rule of an observer who always gives the same answer.
Rule always(int answer);

/// Returns the rule with the highest proportion correct in the trials `looks`.
Rule best_rule(const Asked& asked, const std::vector<Look>& looks, const Grain& grain);

/// Returns the places at which a range of the cue may end, in ascending order, for one interval. They lie
/// between different values of the cue. If there are more than `count` such places, those are returned that
/// divide the weight of the trials `looks` about equally, and those on both sides of a value that has as much
/// weight by itself.
std::vector<double> places(const std::vector<Look>& looks, const Grain& grain, int count);

}  // namespace turnpoint::rehearsal

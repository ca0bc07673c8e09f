#include <algorithm>
#include <utility>

#include "station/simulation/cue_observer.hpp"

namespace turnpoint::simulation {

using protocol::TaskKind;

namespace {

/// In a yes/no task with a procedure that follows the answers, the observer's answers decide how often each
/// answer is right, so the best rule is not known beforehand. Tried are the rules that are best if the first
/// answer is right this many times as often as the other (the corners of the cue's ROC curve), and criteria
/// between them. The rules that do best in a few sessions are then judged in sessions of their own.
constexpr double tried_odds[] = {0.12, 0.16, 0.21, 0.27, 0.35, 0.46, 0.59, 0.77, 1,
                                 1.3,  1.7,  2.2,  2.9,  3.7,  4.8,  6.3,  8.2};
constexpr int tried_places = 96, few_sessions = 20, tried_sessions = 60;
constexpr std::size_t tried_criteria = 24, judged_rules = 3;
constexpr std::uint64_t tried_seed = 1'000'000;  // seed of the first of these sessions

}  // namespace

std::vector<Feature> CueObserver::features_of(const CueKind& kind) const {
  const bool change = kind.source == Source::surface && protocol_.task.kind == TaskKind::single_interval &&
                      protocol_.task.intervals.front().size() > 1;
  if (change) return {Feature::last, Feature::change, Feature::first};
  return {Feature::last};
}

/// The best strategy if the first answer is right `odds` times as often as each other or, without odds, if
/// each kind of trial is as frequent as in the census.
Strategy CueObserver::best_strategy(const CueKind& kind, const Grain& grain, const Cells& all,
                                    std::optional<double> odds) const {
  Strategy best;
  double most = -1;
  for (const auto feature : features_of(kind)) {
    auto looked = looks(kind, feature, all, Draws::to_choose);
    if (odds) weight_by_answer(looked, *odds);
    const Strategy strategy{feature, best_rule(asked_, looked, grain)};
    const double right = accuracy(strategy.rule, asked_, looked);
    if (right > most) most = right, best = strategy;
  }
  return best;
}

/// The gain of a strategy over the best key in a few sessions of its own.
double CueObserver::tried_gain(const CueKind& kind, const Strategy& strategy, int sessions) {
  OwnSessions own;
  run_sessions(kind, strategy, sessions, own, tried_seed);
  const auto sum = sum_of(own.done);
  return sum.accuracy() - chance(sum);
}

/// Keeps the strategies that do best in this many sessions.
void CueObserver::keep_best(const CueKind& kind, std::vector<Tried>& tried, int sessions, std::size_t count) {
  for (auto& one : tried) one.gain = tried_gain(kind, one.strategy, sessions);
  std::stable_sort(tried.begin(), tried.end(),
                   [](const Tried& a, const Tried& b) { return a.gain > b.gain; });
  tried.resize(std::min(tried.size(), count));
}

/// Moves the ends of the strategy's ranges among the given places while that helps, first in larger steps.
void CueObserver::improve(const CueKind& kind, const std::vector<double>& places, Tried& tried) {
  const auto count = static_cast<std::ptrdiff_t>(places.size());
  for (const std::ptrdiff_t step : {8, 3, 1})
    for (bool better = true; better;) {
      better = false;
      for (std::size_t k = 0; k + 1 < tried.strategy.rule.ranges.size(); ++k)
        for (const auto by : {-step, step}) {
          auto moved = tried;
          auto& ranges = moved.strategy.rule.ranges;
          const auto at = std::lower_bound(places.begin(), places.end(), ranges[k].end) - places.begin() + by;
          if (at < 0 || at >= count) continue;
          ranges[k].end = places[static_cast<std::size_t>(at)];
          if (ranges[k].end >= ranges[k + 1].end || (k > 0 && ranges[k].end <= ranges[k - 1].end)) continue;
          moved.gain = tried_gain(kind, moved.strategy, tried_sessions);
          if (moved.gain > tried.gain) tried = std::move(moved), better = true;
        }
    }
}

/// The strategies for a single interval that do best in a few sessions of their own.
std::vector<Strategy> CueObserver::promising(const CueKind& kind, const Grain& grain, const Cells& all) {
  if (asked_.answers != 2) return {best_strategy(kind, grain, all, 1.0)};
  std::vector<Tried> tried;
  for (const double odds : tried_odds) {
    auto strategy = best_strategy(kind, grain, all, odds);
    const bool is_new =
        std::none_of(tried.begin(), tried.end(), [&](const Tried& one) { return one.strategy == strategy; });
    if (is_new) tried.push_back({std::move(strategy)});
  }
  std::map<Feature, std::vector<double>> places;
  for (const auto feature : features_of(kind)) {
    auto looked = looks(kind, feature, all, Draws::to_choose);
    weight_by_answer(looked, 1);
    auto rules = criteria(asked_, looked, grain, tried_places);
    const std::size_t stride = std::max<std::size_t>(1, rules.size() / tried_criteria);
    for (std::size_t k = 0; k < rules.size(); ++k) {
      places[feature].push_back(rules[k].ranges.front().end);
      if (k % stride == 0) tried.push_back({{feature, std::move(rules[k])}});
    }
  }
  // the best of all in a few sessions, then the best of those in more sessions
  keep_best(kind, tried, few_sessions, 12);
  keep_best(kind, tried, tried_sessions, judged_rules);
  std::vector<Strategy> best;
  for (auto& one : tried) {
    improve(kind, places[one.strategy.feature], one);
    best.push_back(one.strategy);
  }
  return best;
}

}  // namespace turnpoint::simulation

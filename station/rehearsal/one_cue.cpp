#include "station/rehearsal/one_cue.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "station/rehearsal/best_ranges.hpp"
#include "station/trial/orders.hpp"

namespace turnpoint::rehearsal {

namespace {

using protocol::TaskKind;

double banded(Statistic statistic, const CueValues& x) {
  return statistic == Statistic::value ? x[0] : std::fabs(x[1] - x[0]);
}

/// The statistics by which an observer can choose one of several intervals.
std::vector<Statistic> choosing(TaskKind task) {
  if (task == TaskKind::abx || task == TaskKind::match_to_sample)
    return {Statistic::nearest, Statistic::farthest};
  return {Statistic::most, Statistic::least, Statistic::odd, Statistic::even};
}

struct Comparison {
  const Rule& rule;
  const CueValues& x;
  const Asked& asked;

  double difference(double a, double b) const {
    const auto& grain = rule.grain;
    const double none =
        grain.relative > 0 ? grain.relative * std::max(std::fabs(a), std::fabs(b)) : grain.absolute;
    return std::fabs(a - b) <= none ? 0.0 : a - b;
  }

  // Returns the score of answer `i`; the observer chooses the answer with the highest score.
  double score(std::size_t i) const {
    const std::size_t intervals = asked.intervals;
    if (rule.statistic == Statistic::nearest || rule.statistic == Statistic::farthest) {
      const bool sample_first = asked.kind == TaskKind::match_to_sample;
      const double distance = std::fabs(difference(x[sample_first ? i + 1 : i], x[sample_first ? 0 : 2]));
      return rule.statistic == Statistic::farthest ? distance : -distance;
    }
    const bool unlike = rule.statistic == Statistic::odd || rule.statistic == Statistic::even;
    const double sign = rule.statistic == Statistic::most || rule.statistic == Statistic::odd ? 1 : -1;
    if (unlike && intervals == 2) return sign * std::fabs(difference(x[i], rule.usual));
    double sum = 0;
    for (std::size_t j = 0; j < intervals; ++j) {
      const double d = difference(x[i], x[j]);
      sum += unlike ? std::fabs(d) : d;
    }
    return sign * sum;
  }
};

// Returns the mean value of the cue over those intervals that are wrong answers.
double usual_of(const std::vector<Look>& looks) {
  double sum = 0, weight = 0;
  for (const auto& look : looks) {
    sum += look.weight * look.x[static_cast<std::size_t>(1 - look.correct)];
    weight += look.weight;
  }
  return weight > 0 ? sum / weight : 0;
}

}  // namespace

Asked asked_by(const protocol::Task& task) {
  return {task.kind, trial::orders_of(task).front().intervals.size(), task.choices.size()};
}

Shares shares(const Rule& rule, const Asked& asked, const CueValues& x) {
  Shares shares{};
  if (rule.statistic == Statistic::value || rule.statistic == Statistic::change) {
    const double value = banded(rule.statistic, x);
    const auto range = std::find_if(rule.ranges.begin(), rule.ranges.end(),
                                    [value](const CueRange& one) { return value < one.end; });
    shares[range == rule.ranges.end() ? 0 : static_cast<std::size_t>(range->answer)] = 1;
    return shares;
  }
  const Comparison comparison{rule, x, asked};
  Shares scores{};
  for (std::size_t i = 0; i < asked.answers; ++i) scores[i] = comparison.score(i);
  const double best =
      *std::max_element(scores.begin(), scores.begin() + static_cast<std::ptrdiff_t>(asked.answers));
  const double equal = best - 1e-9 * std::fabs(best);
  double ties = 0;
  for (std::size_t i = 0; i < asked.answers; ++i) ties += scores[i] >= equal ? 1 : 0;
  for (std::size_t i = 0; i < asked.answers; ++i) shares[i] = scores[i] >= equal ? 1 / ties : 0;
  return shares;
}

double accuracy(const Rule& rule, const Asked& asked, const std::vector<Look>& looks) {
  double right = 0, all = 0;
  for (const auto& look : looks) {
    right += look.weight * shares(rule, asked, look.x)[static_cast<std::size_t>(look.correct)];
    all += look.weight;
  }
  return all > 0 ? right / all : 0;
}

void weight_by_answer(std::vector<Look>& looks) {
  Shares sums{};
  for (const auto& look : looks) sums[static_cast<std::size_t>(look.correct)] += look.weight;
  for (auto& look : looks) look.weight /= sums[static_cast<std::size_t>(look.correct)];
}

Rule always(int answer) {
  Rule rule;
  rule.ranges = {{std::numeric_limits<double>::infinity(), answer}};
  return rule;
}

Rule best_rule(const Asked& asked, const std::vector<Look>& looks, const Grain& grain) {
  Rule best;
  best.grain = grain;
  if (asked.kind == TaskKind::single_interval || asked.kind == TaskKind::same_different) {
    best.statistic = asked.kind == TaskKind::single_interval ? Statistic::value : Statistic::change;
    std::vector<Weighed> values;
    for (const auto& look : looks)
      values.push_back({banded(best.statistic, look.x), look.correct, look.weight});
    best.ranges = best_ranges(std::move(values), asked.answers, grain.absolute);
    return best;
  }
  double most = -1;
  for (const auto statistic : choosing(asked.kind)) {
    Rule rule;
    rule.statistic = statistic, rule.grain = grain;
    if (asked.kind == TaskKind::two_interval) rule.usual = usual_of(looks);
    const double right = accuracy(rule, asked, looks);
    if (right > most + 1e-9) most = right, best = rule;
  }
  return best;
}

std::vector<double> places(const std::vector<Look>& looks, const Grain& grain, int count) {
  std::vector<std::pair<double, double>> values;
  for (const auto& look : looks) values.emplace_back(look.x[0], look.weight);
  std::sort(values.begin(), values.end());
  std::vector<std::pair<double, double>> gaps;  // a place, and the weight of the trials below it
  double below = 0, first = 0, before = 0;
  for (const auto& [value, weight] : values) {
    if (below > 0 && value - first > grain.absolute) gaps.emplace_back(0.5 * (before + value), below);
    if (below == 0 || value - first > grain.absolute) first = value;
    below += weight, before = value;
  }
  const double step = gaps.size() > static_cast<std::size_t>(count) ? below / (count + 1) : 0;
  std::vector<double> places;
  double wanted = step;
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const auto [place, weight] = gaps[k];
    const double up_to_next = (k + 1 < gaps.size() ? gaps[k + 1].second : below) - weight;
    if (weight >= wanted || up_to_next >= step) places.push_back(place);
    while (step > 0 && wanted <= weight) wanted += step;
  }
  return places;
}

}  // namespace turnpoint::rehearsal

#include "station/simulation/one_cue.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace turnpoint::simulation {

namespace {

using protocol::TaskKind;

constexpr double infinity = std::numeric_limits<double>::infinity();

std::size_t intervals_of(TaskKind task) {
  return task == TaskKind::oddity ? 3 : task == TaskKind::single_interval ? 1 : 2;
}

double banded(const Rule& rule, const std::array<double, 3>& x) {
  return rule.statistic == Statistic::value ? x[0] : std::fabs(x[1] - x[0]);
}

// Scores each interval; the observer chooses the interval with the highest score.
std::array<double, 3> scores(const Rule& rule, std::size_t intervals, const std::array<double, 3>& x) {
  const auto difference = [&](double a, double b) {
    const auto& grain = rule.grain;
    const double none =
        grain.relative > 0 ? grain.relative * std::max(std::fabs(a), std::fabs(b)) : grain.absolute;
    return std::fabs(a - b) <= none ? 0.0 : a - b;
  };
  const bool unlike = rule.statistic == Statistic::odd || rule.statistic == Statistic::even;
  const double sign = rule.statistic == Statistic::most || rule.statistic == Statistic::odd ? 1 : -1;
  std::array<double, 3> all{};
  for (std::size_t i = 0; i < intervals; ++i) {
    if (unlike && intervals == 2) all[i] = std::fabs(difference(x[i], rule.usual));
    for (std::size_t j = 0; j < intervals; ++j) {
      if (unlike && intervals == 2) continue;
      const double d = difference(x[i], x[j]);
      all[i] += unlike ? std::fabs(d) : d;
    }
    all[i] *= sign;
  }
  return all;
}

struct Weighed {
  double value = 0;
  int answer = 0;
  double weight = 0;
};

// A group of neighbouring cue values that count as equal. `excess` is the weight of the trials in which the
// one answer is right, minus the weight of the trials in which the other answer is right.
struct Group {
  double first = 0, last = 0, excess = 0;
};

// Finds the best band: if the cue lies within it, the observer gives the answer `inside`, otherwise the other
// answer. The best band is the run of neighbouring groups with the largest sum of `excess` (Kadane's
// algorithm).
Rule best_band(std::vector<Weighed> values, Statistic statistic, const Grain& grain) {
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  std::vector<Group> groups;
  for (const auto& value : values) {
    if (groups.empty() || value.value - groups.back().first > grain.absolute)
      groups.push_back({value.value, value.value, 0});
    groups.back().last = value.value;
    groups.back().excess += value.answer == 0 ? value.weight : -value.weight;
  }
  double total[2] = {0, 0};
  for (const auto& value : values) total[value.answer] += value.weight;
  Rule best;
  best.statistic = statistic, best.grain = grain;
  double most = -infinity;
  for (const int inside : {0, 1}) {
    const double sign = inside == 0 ? 1 : -1;
    double sum = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      if (sum <= 0) sum = 0, begin = i;
      sum += sign * groups[i].excess;
      if (total[1 - inside] + sum <= most + 1e-12) continue;
      most = total[1 - inside] + sum;
      best.inside = inside;
      best.low = begin == 0 ? -infinity : 0.5 * (groups[begin - 1].last + groups[begin].first);
      best.high = i + 1 == groups.size() ? infinity : 0.5 * (groups[i].last + groups[i + 1].first);
    }
  }
  return best;
}

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

std::array<double, 3> shares(const Rule& rule, TaskKind task, const std::array<double, 3>& x) {
  std::array<double, 3> shares{};
  if (rule.statistic == Statistic::value || rule.statistic == Statistic::change) {
    const double value = banded(rule, x);
    const int answer = value >= rule.low && value < rule.high ? rule.inside : 1 - rule.inside;
    shares[static_cast<std::size_t>(answer)] = 1;
    return shares;
  }
  const auto intervals = intervals_of(task);
  const auto all = scores(rule, intervals, x);
  const double best = *std::max_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(intervals));
  const double equal = best - 1e-9 * std::fabs(best);
  double ties = 0;
  for (std::size_t i = 0; i < intervals; ++i) ties += all[i] >= equal ? 1 : 0;
  for (std::size_t i = 0; i < intervals; ++i) shares[i] = all[i] >= equal ? 1 / ties : 0;
  return shares;
}

double accuracy(const Rule& rule, TaskKind task, const std::vector<Look>& looks) {
  double right = 0, all = 0;
  for (const auto& look : looks) {
    right += look.weight * shares(rule, task, look.x)[static_cast<std::size_t>(look.correct)];
    all += look.weight;
  }
  return all > 0 ? right / all : 0;
}

Rule best_rule(TaskKind task, const std::vector<Look>& looks, const Grain& grain) {
  if (task == TaskKind::single_interval || task == TaskKind::same_different) {
    const auto statistic = task == TaskKind::single_interval ? Statistic::value : Statistic::change;
    Rule rule;
    rule.statistic = statistic;
    std::vector<Weighed> values;
    for (const auto& look : looks) values.push_back({banded(rule, look.x), look.correct, look.weight});
    return best_band(std::move(values), statistic, grain);
  }
  Rule best;
  double most = -1;
  for (const auto statistic : {Statistic::most, Statistic::least, Statistic::odd, Statistic::even}) {
    Rule rule;
    rule.statistic = statistic, rule.grain = grain;
    if (task == TaskKind::two_interval) rule.usual = usual_of(looks);
    const double right = accuracy(rule, task, looks);
    if (right > most + 1e-9) most = right, best = rule;
  }
  return best;
}

}  // namespace turnpoint::simulation

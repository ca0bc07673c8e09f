#include "tests/rehearsal/cue_strategies.hpp"

#include <algorithm>
#include <cmath>

namespace turnpoint::tests {

using protocol::TaskKind;

namespace {

double banded(const std::vector<double>& x, bool distance) {
  return distance ? std::fabs(x[1] - x[0]) : x[0];
}

std::vector<double> cuts_in(const Shown& shown, double grain, bool distance) {
  std::vector<std::pair<double, double>> values;
  for (const auto& [trial, count] : shown) values.emplace_back(banded(trial.first, distance), count);
  return cuts_of(std::move(values), grain, 80);
}

std::vector<int> extremes(const std::vector<double>& score) {
  const double most = *std::max_element(score.begin(), score.end());
  std::vector<int> answers;
  for (std::size_t i = 0; i < score.size(); ++i)
    if (score[i] >= most - 1e-12 * std::fabs(most)) answers.push_back(static_cast<int>(i));
  return answers;
}

std::vector<Strategy> choices(const Shown& shown, std::size_t cue) {
  double usual = 0, all = 0;
  for (const auto& [trial, count] : shown)
    if (trial.first.size() == 2)
      usual += count * trial.first[static_cast<std::size_t>(1 - trial.second)], all += count;
  usual /= std::max(all, 1.0);
  std::vector<Strategy> strategies;
  for (const double sign : {1.0, -1.0})
    for (const bool unlike : {false, true})
      strategies.emplace_back([=](const std::vector<double>& x) {
        std::vector<double> score(x.size(), 0.0);
        const auto differ = [&](double a, double b) {
          const double none = cue == loudness ? 0.01 : 1e-3 * std::max(std::fabs(a), std::fabs(b));
          return std::fabs(a - b) > none ? a - b : 0.0;
        };
        for (std::size_t i = 0; i < x.size(); ++i) {
          if (unlike && x.size() == 2) score[i] = sign * std::fabs(differ(x[i], usual));
          for (std::size_t j = 0; j < x.size(); ++j)
            if (!(unlike && x.size() == 2))
              score[i] += sign * (unlike ? std::fabs(differ(x[i], x[j])) : differ(x[i], x[j]));
        }
        return extremes(score);
      });
  return strategies;
}

/// Returns the strategies that choose the interval that is more, or less, like X. X is interval `x_at`; the
/// other two intervals are the answers.
std::vector<Strategy> likenesses(std::size_t cue, std::size_t x_at) {
  std::vector<Strategy> strategies;
  for (const bool alike : {true, false})
    strategies.emplace_back([=](const std::vector<double>& x) {
      std::vector<double> score;
      for (std::size_t i = 0; i < x.size(); ++i) {
        if (i == x_at) continue;
        const double none = cue == loudness ? 0.01 : 1e-3 * std::max(std::fabs(x[i]), std::fabs(x[x_at]));
        const double gap = std::fabs(x[i] - x[x_at]) > none ? std::fabs(x[i] - x[x_at]) : 0.0;
        score.push_back(alike ? -gap : gap);
      }
      return extremes(score);
    });
  return strategies;
}

}  // namespace

double grain_of(std::size_t cue, const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::max(largest, std::fabs(value));
  return cue == loudness ? 0.01 : 1e-3 * largest;
}

Strategy band(double lowest, double highest, int inside, bool distance) {
  return [=](const std::vector<double>& x) {
    const double value = banded(x, distance);
    return std::vector<int>{value >= lowest && value < highest ? inside : 1 - inside};
  };
}

std::vector<double> cuts_of(std::vector<std::pair<double, double>> values, double grain, std::size_t most) {
  struct Group {
    double first, last, weight;
  };
  std::sort(values.begin(), values.end());
  std::vector<Group> groups;
  double all = 0;
  for (const auto& [value, weight] : values) {
    if (groups.empty() || value - groups.back().first > grain) groups.push_back({value, value, 0});
    groups.back().last = value, groups.back().weight += weight, all += weight;
  }
  const double step = all / static_cast<double>(most + 1);
  std::vector<double> cuts{-1e300};
  double below = 0, wanted = step;
  for (std::size_t i = 1; i < groups.size(); ++i) {
    below += groups[i - 1].weight;
    const bool frequent = std::max(groups[i - 1].weight, groups[i].weight) >= step;
    if (groups.size() <= most + 1 || frequent || below >= wanted)
      cuts.push_back(0.5 * (groups[i - 1].last + groups[i].first));
    while (wanted <= below) wanted += step;
  }
  cuts.push_back(1e300);
  return cuts;
}

double expected(const Strategy& strategy, const Shown& shown) {
  double right = 0, all = 0;
  for (const auto& [trial, count] : shown) {
    const auto answers = strategy(trial.first);
    all += count;
    if (std::count(answers.begin(), answers.end(), trial.second))
      right += count / static_cast<double>(answers.size());
  }
  return right / all;
}

Strategy best_cuts(const Shown& shown, double grain, bool distance) {
  const auto cuts = cuts_in(shown, grain, distance);
  // For each criterion and each answer, the number of trials below the criterion for which the answer is
  // right.
  std::vector<std::array<double, 2>> below(cuts.size(), {0, 0});
  for (const auto& [trial, count] : shown) {
    const auto above = std::upper_bound(cuts.begin(), cuts.end(), banded(trial.first, distance));
    below[static_cast<std::size_t>(above - cuts.begin())][static_cast<std::size_t>(trial.second)] += count;
  }
  for (std::size_t c = 1; c < cuts.size(); ++c)
    for (const std::size_t answer : {0, 1}) below[c][answer] += below[c - 1][answer];
  double most = -1;
  std::size_t low = 0, high = cuts.size() - 1;
  int inside = 0;
  for (std::size_t a = 0; a < cuts.size(); ++a)
    for (std::size_t b = a + 1; b < cuts.size(); ++b)
      for (const int answer : {0, 1}) {
        const auto in = static_cast<std::size_t>(answer), out = static_cast<std::size_t>(1 - answer);
        const double right =
            below[b][in] - below[a][in] + below.back()[out] - (below[b][out] - below[a][out]);
        if (right > most + 1e-9) most = right, low = a, high = b, inside = answer;
      }
  return band(cuts[low], cuts[high], inside, distance);
}

Strategy best_parts(const Shown& shown, double grain, int answers) {
  const auto cuts = cuts_in(shown, grain, false);
  std::vector<std::vector<double>> below(cuts.size(), std::vector<double>(static_cast<std::size_t>(answers)));
  for (std::size_t c = 0; c < cuts.size(); ++c)
    for (const auto& [trial, count] : shown)
      if (trial.first[0] < cuts[c]) below[c][static_cast<std::size_t>(trial.second)] += count;
  struct Part {
    double right = -1;
    std::vector<std::pair<double, int>> ends;
  };
  std::vector<Part> parts(cuts.size());  // the best division of the values below each cut
  parts[0].right = 0;
  for (int count = 0; count <= answers; ++count) {
    auto longer = parts;
    for (std::size_t b = 1; b < cuts.size(); ++b)
      for (std::size_t a = 0; a < b; ++a)
        for (int answer = 0; parts[a].right >= 0 && answer < answers; ++answer) {
          const auto i = static_cast<std::size_t>(answer);
          const double right = parts[a].right + below[b][i] - below[a][i];
          if (right <= longer[b].right + 1e-9) continue;
          longer[b] = parts[a];
          longer[b].right = right;
          longer[b].ends.emplace_back(cuts[b], answer);
        }
    parts = std::move(longer);
  }
  return [ends = parts.back().ends](const std::vector<double>& x) {
    for (const auto& [end, answer] : ends)
      if (x[0] < end) return std::vector<int>{answer};
    return std::vector<int>{ends.back().second};
  };
}

Strategy best_choice(const Shown& shown, std::size_t cue, TaskKind kind) {
  Strategy best;
  double most = -1;
  const auto all = kind == TaskKind::abx               ? likenesses(cue, 2)
                   : kind == TaskKind::match_to_sample ? likenesses(cue, 0)
                                                       : choices(shown, cue);
  for (const auto& strategy : all) {
    const double right = expected(strategy, shown);
    if (right > most + 1e-9) most = right, best = strategy;
  }
  return best;
}

}  // namespace turnpoint::tests

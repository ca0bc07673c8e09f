#include "station/analysis/followed.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "station/analysis/quantile.hpp"
#include "station/analysis/student.hpp"

namespace turnpoint::analysis {

namespace {

using FollowValue = std::optional<double> core::FollowRow::*;

std::vector<double> followed_values(const std::vector<const FollowedTrial*>& trials, FollowValue value) {
  std::vector<double> values;
  for (const auto* trial : trials)
    if (trial->follow.*value) values.push_back(*(trial->follow.*value));
  return values;
}

FollowedCondition condition_of(const std::string& name, const std::vector<const FollowedTrial*>& trials) {
  using core::FollowRow;
  const auto mean_of = [&](FollowValue value) { return student_mean(followed_values(trials, value)); };
  FollowedCondition condition;
  condition.condition = name;
  condition.trials = static_cast<int>(trials.size());
  condition.faultless = static_cast<int>(
      std::ranges::count_if(trials, [](const auto* trial) { return trial->follow.followed == "ok"; }));
  condition.mu_asked = mean_of(&FollowRow::mu_asked);
  condition.mu_commanded = mean_of(&FollowRow::mu_commanded);
  condition.mu_felt = mean_of(&FollowRow::mu_felt);
  condition.lag_ms = mean_of(&FollowRow::lag_ms);
  condition.inside = student_proportion(followed_values(trials, &FollowRow::inside));
  condition.share = student_proportion(followed_values(trials, &FollowRow::share));
  condition.envelope_error_dB = mean_of(&FollowRow::envelope_error_dB);
  condition.envelope_lag_us = mean_of(&FollowRow::envelope_lag_us);
  return condition;
}

Spread spread_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {sorted_quantile(values, 0.5), sorted_quantile(values, 0.25), sorted_quantile(values, 0.75)};
}

/// The values of the intervals in one bin.
struct FollowBin {
  std::vector<double> asked, commanded, felt, deviation;
};
using FollowBins = std::map<long, FollowBin>;

/// Adds the means of one interval to the bins of both directions.
void add(const FollowedPath& path, FollowBins& narrow, FollowBins& wide) {
  struct Sum {
    double asked = 0, commanded = 0, felt = 0, points = 0;
  };
  std::map<std::pair<bool, long>, Sum> sums;
  for (const auto& point : path.points) {
    auto& sum = sums[{point.narrow, std::lround(std::floor(point.place_mm / kFollowedBin_mm))}];
    sum.asked += point.asked, sum.commanded += point.commanded, sum.felt += point.felt, ++sum.points;
  }
  for (const auto& [at, sum] : sums) {
    auto& bin = (at.first ? narrow : wide)[at.second];
    bin.asked.push_back(sum.asked / sum.points);
    bin.commanded.push_back(sum.commanded / sum.points);
    bin.felt.push_back(sum.felt / sum.points);
    bin.deviation.push_back(sum.felt / sum.asked - 1);
  }
}

}  // namespace

std::vector<FollowedPlaces> friction_over_place(const std::vector<FollowedPath>& paths) {
  struct Group {
    const FollowedPath* first;
    FollowBins narrow, wide;
  };
  std::vector<Group> groups;
  for (const auto& path : paths) {
    auto found = std::ranges::find_if(groups, [&](const auto& group) {
      return group.first->condition == path.condition && group.first->scene == path.scene;
    });
    if (found == groups.end()) found = groups.insert(found, Group{&path, {}, {}});
    add(path, found->narrow, found->wide);
  }
  std::vector<FollowedPlaces> all;
  for (const auto& group : groups)
    for (const bool narrow : {true, false}) {
      FollowedPlaces places{group.first->condition, group.first->scene, narrow, {}, {}, {}, {}, {}};
      for (const auto& [index, bin] : narrow ? group.narrow : group.wide) {
        if (static_cast<int>(bin.felt.size()) < kFewestFollowed) continue;
        places.place_mm.push_back((static_cast<double>(index) + 0.5) * kFollowedBin_mm);
        places.asked.push_back(spread_of(bin.asked));
        places.commanded.push_back(spread_of(bin.commanded));
        places.felt.push_back(spread_of(bin.felt));
        places.deviation.push_back(spread_of(bin.deviation));
      }
      if (!places.place_mm.empty()) all.push_back(std::move(places));
    }
  return all;
}

std::vector<FollowedCondition> followed(const std::vector<FollowedTrial>& trials,
                                        const std::vector<std::string>& order) {
  auto names = order;
  for (const auto& trial : trials)
    if (std::ranges::find(names, trial.condition) == names.end()) names.push_back(trial.condition);
  std::vector<FollowedCondition> conditions;
  for (const auto& name : names) {
    std::vector<const FollowedTrial*> of_name;
    for (const auto& trial : trials)
      if (trial.condition == name) of_name.push_back(&trial);
    if (!of_name.empty()) conditions.push_back(condition_of(name, of_name));
  }
  return conditions;
}

}  // namespace turnpoint::analysis

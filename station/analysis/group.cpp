#include "station/analysis/group.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "station/analysis/quantile.hpp"
#include "station/analysis/student.hpp"
#include "station/analysis/trade.hpp"

namespace turnpoint::analysis {

namespace {

/// The values of one measure in one condition, by participant.
struct Column {
  std::string measure, unit, condition;
  std::vector<std::pair<std::string, double>> values;

  std::vector<double> numbers() const {
    std::vector<double> all;
    for (const auto& [person, value] : values) all.push_back(value);
    return all;
  }
};

std::vector<Column> samples_of(const std::vector<PersonMeasure>& measures) {
  std::vector<Column> samples;
  for (const auto& entry : measures) {
    auto found = std::find_if(samples.begin(), samples.end(), [&entry](const Column& sample) {
      return sample.measure == entry.measure && sample.condition == entry.condition;
    });
    if (found == samples.end())
      found = samples.insert(samples.end(), {entry.measure, entry.unit, entry.condition, {}});
    found->values.emplace_back(entry.person, entry.value);
  }
  std::vector<std::string> order;
  for (const auto& sample : samples) order.push_back(sample.measure);
  const auto place = [&order](const Column& sample) {
    return std::find(order.begin(), order.end(), sample.measure) - order.begin();
  };
  std::stable_sort(samples.begin(), samples.end(),
                   [&place](const Column& a, const Column& b) { return place(a) < place(b); });
  return samples;
}

Effect effect_of_groups(const Column& first, const Column& second) {
  const auto a = first.numbers(), b = second.numbers();
  Effect effect{first.measure, first.unit, first.condition, second.condition, 0, {}, {}, true};
  effect.persons = static_cast<int>(a.size() + b.size());
  effect.difference = student_difference(b, a);
  if (!effect.difference) return effect;
  const auto squares = [](const std::vector<double>& values) {
    return variance(values) * static_cast<double>(values.size() - 1);
  };
  const double pooled = std::sqrt((squares(a) + squares(b)) / static_cast<double>(a.size() + b.size() - 2));
  if (pooled > 0) effect.standardised = effect.difference->value / pooled;
  return effect;
}

Effect effect_of(const Column& first, const Column& second, const Between& between) {
  if (between(first.condition, second.condition)) return effect_of_groups(first, second);
  const std::map<std::string, double> before(first.values.begin(), first.values.end());
  std::vector<double> differences;
  for (const auto& [person, value] : second.values)
    if (const auto found = before.find(person); found != before.end())
      differences.push_back(value - found->second);
  Effect effect{first.measure, first.unit, first.condition, second.condition, 0, {}, {}};
  effect.persons = static_cast<int>(differences.size());
  effect.difference = student_mean(differences);
  if (!effect.difference) return effect;
  const double sd = std::sqrt(variance(differences));
  if (sd > 0) effect.standardised = effect.difference->value / sd;
  return effect;
}

}  // namespace

std::vector<GroupMean> group_means(const std::vector<PersonMeasure>& measures) {
  std::vector<GroupMean> means;
  for (const auto& sample : samples_of(measures)) {
    const auto values = sample.numbers();
    GroupMean mean{sample.measure, sample.unit, sample.condition, static_cast<int>(values.size()), {}, {}};
    mean.mean = is_proportion(sample.measure) ? student_proportion(values) : student_mean(values);
    if (mean.mean) mean.sd = std::sqrt(variance(values));
    means.push_back(std::move(mean));
  }
  return means;
}

std::vector<std::optional<double>> holm(const std::vector<Tested>& tests) {
  std::map<std::string, std::vector<std::size_t>> families;
  for (std::size_t i = 0; i < tests.size(); ++i)
    if (tests[i].p) families[tests[i].family].push_back(i);
  std::vector<std::optional<double>> corrected(tests.size());
  for (auto& [name, members] : families) {
    std::stable_sort(members.begin(), members.end(),
                     [&tests](std::size_t a, std::size_t b) { return *tests[a].p < *tests[b].p; });
    double reached = 0;
    for (std::size_t i = 0; i < members.size(); ++i) {
      reached = std::max(reached, static_cast<double>(members.size() - i) * *tests[members[i]].p);
      corrected[members[i]] = std::min(reached, 1.0);
    }
  }
  return corrected;
}

std::vector<Effect> effects(const std::vector<PersonMeasure>& measures, const Between& between) {
  std::vector<Effect> all;
  const auto samples = samples_of(measures);
  for (std::size_t i = 0; i < samples.size(); ++i)
    for (std::size_t j = i + 1; j < samples.size() && samples[j].measure == samples[i].measure; ++j)
      all.push_back(effect_of(samples[i], samples[j], between));
  return all;
}

}  // namespace turnpoint::analysis

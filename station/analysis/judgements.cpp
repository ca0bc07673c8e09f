#include "station/analysis/judgements.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "station/analysis/quantile.hpp"
#include "station/analysis/student.hpp"

namespace turnpoint::analysis {

namespace {

void add_geometric_mean(JudgedLevel& level) {
  std::vector<double> logs;
  for (const double value : level.values) logs.push_back(std::log10(value));
  level.mean = student_mean(logs);
  if (!level.mean) return;
  for (auto* end : {&level.mean->value, &level.mean->interval.low, &level.mean->interval.high})
    *end = std::pow(10.0, *end);
}

void add_exponent(Judgements& judgements, bool decibel) {
  std::vector<double> x, y;
  bool sizes = true;
  for (const auto& level : judgements.levels) {
    sizes = sizes && (decibel || level.level > 0);
    if (!sizes) break;
    for (const double value : level.values) {
      x.push_back(decibel ? level.level / 20 : std::log10(level.level));
      y.push_back(std::log10(value));
    }
  }
  if (!sizes) {
    judgements.statements.push_back({"no-logarithm", core::phrase("statement.no_logarithm")});
    return;
  }
  judgements.exponent = student_slope(x, y);
  if (!judgements.exponent)
    judgements.statements.push_back({"few-magnitudes", core::phrase("statement.few_magnitudes")});
}

}  // namespace

std::vector<Judgements> judgements(const std::vector<TrialRecord>& trials,
                                   const std::vector<std::string>& order, Judged judged) {
  std::vector<Judgements> all;
  for (const auto& condition : conditions_of(trials, order)) {
    Judgements one;
    one.condition = condition;
    std::map<double, JudgedLevel> levels;
    int zeros = 0;
    for (const auto& trial : trials) {
      if (!counted(trial) || !trial.setting || trial.instruction != condition) continue;
      if (judged != Judged::ratings && *trial.setting <= 0)
        ++zeros;
      else
        levels[trial.level.value_or(0)].values.push_back(*trial.setting);
    }
    for (auto& [level, found] : levels) {
      found.level = level;
      found.median = quantile(found.values, 0.5);
      if (judged == Judged::ratings)
        found.mean = student_mean(found.values);
      else
        add_geometric_mean(found);
      one.levels.push_back(std::move(found));
    }
    if (zeros > 0)
      one.statements.push_back(
          {"zero-magnitudes", core::phrase("statement.zero_magnitudes", {core::plain(zeros)})});
    if (one.levels.empty())
      one.statements.push_back({"no-trials", core::phrase("statement.no_trials")});
    else if (judged != Judged::ratings)
      add_exponent(one, judged == Judged::magnitudes_dB);
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace turnpoint::analysis

#include "station/analysis/finger.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "station/analysis/student.hpp"

namespace turnpoint::analysis {

namespace {

constexpr double kNormal95 = 1.96;

using Value = std::optional<double> FingerTrial::*;

std::optional<Estimate> mean_over(const std::vector<const FingerTrial*>& trials, Value value) {
  std::vector<double> values;
  for (const auto* trial : trials)
    if (trial->*value) values.push_back(*(trial->*value));
  return student_mean(values);
}

std::optional<double> shift_of(const FingerTrial& trial) {
  if (!trial.felt_mm || !trial.planned_mm) return std::nullopt;
  return *trial.felt_mm - *trial.planned_mm;
}

FingerCondition condition_of(const std::string& name, const std::vector<const FingerTrial*>& trials) {
  FingerCondition condition;
  condition.condition = name;
  std::vector<double> shifts;
  for (const auto* trial : trials) {
    ++condition.trials;
    condition.measured += trial->measured ? 1 : 0;
    condition.felt += trial->felt_mm ? 1 : 0;
    if (const auto shift = shift_of(*trial)) shifts.push_back(*shift);
  }
  condition.normal_N = mean_over(trials, &FingerTrial::normal_N);
  condition.speed_mm_s = mean_over(trials, &FingerTrial::speed_mm_s);
  condition.mu_low = mean_over(trials, &FingerTrial::mu_low);
  condition.mu_high = mean_over(trials, &FingerTrial::mu_high);
  condition.shift_mm = student_mean(shifts);
  return condition;
}

/// A value of one trial, and the half-width of its interval if that is known.
struct Single {
  double value = 0;
  std::optional<double> half;
};

void add(std::vector<AtBoundary>& list, double planned_mm, const std::vector<Single>& singles) {
  std::vector<double> values;
  for (const auto& single : singles) values.push_back(single.value);
  if (const auto mean = student_mean(values)) {
    list.push_back({planned_mm, mean->value, static_cast<int>(values.size()), mean->interval});
    return;
  }
  for (const auto& [value, half] : singles)
    list.push_back({planned_mm, value, 1,
                    half ? std::optional(Interval{value - *half, value + *half, 0.95}) : std::nullopt});
}

FeltBoundaries boundaries_of(const std::vector<FingerTrial>& trials) {
  struct OfBoundary {
    std::vector<Single> shift_mm, mu_low, mu_high;
  };
  std::map<long, OfBoundary> groups;  // key: planned boundary in tenths of a mm
  for (const auto& trial : trials) {
    const auto shift = shift_of(trial);
    if (!shift) continue;
    auto& group = groups[std::lround(10 * *trial.planned_mm)];
    group.shift_mm.push_back(
        {*shift, trial.felt_se_mm ? std::optional(kNormal95 * *trial.felt_se_mm) : std::nullopt});
    if (trial.mu_low) group.mu_low.push_back({*trial.mu_low, {}});
    if (trial.mu_high) group.mu_high.push_back({*trial.mu_high, {}});
  }
  FeltBoundaries felt;
  for (const auto& [tenths, group] : groups) {
    const double planned_mm = static_cast<double>(tenths) / 10;
    add(felt.shift_mm, planned_mm, group.shift_mm);
    add(felt.mu_low, planned_mm, group.mu_low);
    add(felt.mu_high, planned_mm, group.mu_high);
  }
  return felt;
}

}  // namespace

std::optional<Finger> finger(const std::vector<FingerTrial>& trials, const std::vector<std::string>& order) {
  if (trials.empty()) return std::nullopt;
  Finger result;
  result.trials = trials;
  auto names = order;
  for (const auto& trial : trials)
    if (std::find(names.begin(), names.end(), trial.condition) == names.end())
      names.push_back(trial.condition);
  for (const auto& name : names) {
    std::vector<const FingerTrial*> of_name;
    for (const auto& trial : trials)
      if (trial.condition == name) of_name.push_back(&trial);
    if (!of_name.empty()) result.conditions.push_back(condition_of(name, of_name));
  }
  result.boundaries = boundaries_of(trials);
  if (result.boundaries.shift_mm.empty())
    result.statements.push_back({"no-felt-boundary", core::phrase("statement.no_felt_boundary")});
  return result;
}

}  // namespace turnpoint::analysis

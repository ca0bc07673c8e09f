#include "station/analysis/course.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "station/analysis/proportion.hpp"
#include "station/analysis/signal_detection.hpp"
#include "station/analysis/student.hpp"
#include "station/core/number.hpp"

namespace turnpoint::analysis {

std::vector<Trace> traces(const std::vector<TrialRecord>& trials) {
  std::vector<Trace> result;
  for (const auto& trial : trials) {
    if (trial.type != TrialType::experimental || !trial.level) continue;
    auto found = std::find_if(result.begin(), result.end(),
                              [&](const Trace& trace) { return trace.procedure == trial.procedure; });
    if (found == result.end()) found = result.insert(result.end(), Trace{trial.procedure, {}});
    found->points.push_back({trial.trial_index, *trial.level, trial.correct, trial.response});
  }
  return result;
}

std::optional<Bias> choice_bias(const std::vector<TrialRecord>& trials) {
  Bias bias;
  YesNoCounts counts;
  int known = 0, second_right = 0;
  for (const auto& trial : trials) {
    if (!counted(trial)) continue;
    if (!trial.response || *trial.response < 0 || *trial.response > 1) continue;
    const bool second = *trial.response == 1;
    ++bias.answered;
    bias.second_choice += second;
    if (!trial.right_choice) continue;
    ++known;
    second_right += *trial.right_choice == 1;
    auto& count = *trial.right_choice == 1 ? (second ? counts.hits : counts.misses)
                                           : (second ? counts.false_alarms : counts.correct_rejections);
    ++count;
  }
  if (bias.answered == 0) return std::nullopt;
  bias.share_second = static_cast<double>(bias.second_choice) / bias.answered;
  bias.interval = wilson(bias.second_choice, bias.answered);
  if (const auto detection = yes_no(counts)) bias.criterion = detection->criterion;
  const double fair = known > 0 ? static_cast<double>(second_right) / known : 0.5;
  if (fair < bias.interval.low || fair > bias.interval.high)
    bias.statements.push_back(
        {"bias", core::phrase("statement.bias", {core::plain(core::number(100 * bias.share_second, 3)),
                                                 core::plain(core::number(100 * fair, 3))})});
  return bias;
}

Proportion proportion(int right, int trials) {
  return {right, trials, static_cast<double>(right) / trials, clopper_pearson(right, trials)};
}

std::optional<Proportion> catch_accuracy(const std::vector<TrialRecord>& trials) {
  Proportion result;
  for (const auto& trial : trials) {
    const bool missed = trial.outcome == Outcome::timeout || trial.outcome == Outcome::anticipation;
    if (trial.type != TrialType::catch_trial ||
        !(missed ? trial.right_choice.has_value() : trial.correct.has_value()))
      continue;
    ++result.trials;
    result.right += !missed && *trial.correct;
  }
  if (result.trials == 0) return std::nullopt;
  return proportion(result.right, result.trials);
}

std::map<int, Proportion> accuracy_by_confidence(const std::vector<TrialRecord>& trials) {
  std::map<int, Proportion> degrees;
  for (const auto& trial : trials) {
    if (trial.type != TrialType::experimental || !trial.confidence || !trial.correct) continue;
    auto& degree = degrees[*trial.confidence];
    ++degree.trials;
    degree.right += *trial.correct;
  }
  for (auto& [confidence, degree] : degrees) degree = proportion(degree.right, degree.trials);
  return degrees;
}

namespace {

struct Sample {
  std::pair<double, std::string> group;
  double trial, value;
};

/// Fits one slope that all groups share, after subtracting from both variables the mean of each group.
std::optional<Trend> within_groups(const std::vector<Sample>& samples) {
  std::map<std::pair<double, std::string>, std::array<double, 3>> sums;
  for (const auto& sample : samples) {
    auto& sum = sums[sample.group];
    sum[0] += 1;
    sum[1] += sample.trial;
    sum[2] += sample.value;
  }
  double xx = 0, xy = 0, yy = 0;
  for (const auto& sample : samples) {
    const auto& sum = sums[sample.group];
    const double x = sample.trial - sum[1] / sum[0], y = sample.value - sum[2] / sum[0];
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  const double freedom = static_cast<double>(samples.size()) - static_cast<double>(sums.size()) - 1;
  if (samples.size() < 20 || freedom < 10 || !(xx > 0)) return std::nullopt;
  const double slope = xy / xx, error = std::sqrt(std::max(0.0, yy - slope * xy) / freedom / xx);
  const double z = normal_quantile(0.975);
  return Trend{100 * slope, {100 * (slope - z * error), 100 * (slope + z * error), 0.95}};
}

}  // namespace

Fatigue fatigue(const std::vector<TrialRecord>& trials) {
  std::vector<Sample> times, scores;
  for (const auto& trial : trials) {
    if (!counted(trial)) continue;
    const std::pair group{trial.level.value_or(0), trial.instruction};
    const double index = trial.trial_index;
    if (trial.response_time_s) times.push_back({group, index, *trial.response_time_s});
    if (trial.correct) scores.push_back({group, index, *trial.correct ? 1.0 : 0.0});
  }
  Fatigue result{within_groups(times), within_groups(scores), {}};
  if (result.proportion_correct && result.proportion_correct->interval.high < 0)
    result.statements.push_back({"fatigue", core::phrase("statement.fatigue")});
  if (result.response_time_s && result.response_time_s->interval.low > 0)
    result.statements.push_back({"slowing", core::phrase("statement.slowing")});
  return result;
}

std::optional<Estimate> post_error_slowing(const std::vector<TrialRecord>& trials,
                                           const std::string& condition) {
  const auto is = [&](const TrialRecord& trial, bool right) {
    return counted(trial) && trial.instruction == condition && trial.correct == right &&
           trial.response_time_s;
  };
  std::vector<double> gaps_s;
  for (std::size_t i = 2; i + 1 < trials.size(); ++i) {
    const auto follow = [&](std::size_t at) { return follows(trials[at - 1], trials[at]); };
    if (!follow(i - 1) || !follow(i) || !follow(i + 1)) continue;
    if (is(trials[i - 2], true) && is(trials[i - 1], true) && is(trials[i], false) && is(trials[i + 1], true))
      gaps_s.push_back(*trials[i + 1].response_time_s - *trials[i - 1].response_time_s);
  }
  return student_mean(gaps_s);
}

std::optional<Estimate> repetition(const std::vector<TrialRecord>& trials, const std::string& condition) {
  const auto counts = [&](const TrialRecord& trial) {
    return counted(trial) && trial.instruction == condition && trial.response && trial.right_choice;
  };
  std::vector<double> gaps;
  for (std::size_t i = 1; i < trials.size(); ++i) {
    const auto &before = trials[i - 1], &now = trials[i];
    if (!follows(before, now) || !counts(before) || !counts(now)) continue;
    gaps.push_back((*now.response == *before.response) - (*now.right_choice == *before.response));
  }
  constexpr std::size_t kFewestPairs = 20;
  if (gaps.size() < kFewestPairs) return std::nullopt;
  return student_mean(gaps);
}

OutcomeCounts count_outcomes(const std::vector<TrialRecord>& trials) {
  OutcomeCounts counts;
  for (const auto& trial : trials) {
    if (trial.type == TrialType::practice) continue;
    ++counts.presented;
    switch (trial.outcome) {
      case Outcome::answered:
        ++counts.answered;
        counts.unsure += trial.unsure ? 1 : 0;
        break;
      case Outcome::timeout:
        ++counts.timeouts;
        break;
      case Outcome::anticipation:
        ++counts.anticipations;
        break;
      case Outcome::aborted:
        ++counts.aborted;
        break;
      case Outcome::fault:
        ++counts.faults;
        break;
    }
  }
  return counts;
}

}  // namespace turnpoint::analysis

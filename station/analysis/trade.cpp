#include "station/analysis/trade.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "station/analysis/proportion.hpp"
#include "station/analysis/quantile.hpp"
#include "station/random/draws.hpp"
#include "station/text/number.hpp"

namespace turnpoint::analysis {

namespace {

struct Scored {
  double time_s;
  bool correct;
};
using Cell = std::vector<Scored>;

/// The included trials of one condition, by difficulty.
struct Group {
  std::vector<double> difficulty;
  std::vector<Cell> cells;
};

enum Measure { accuracy, median, boundary, nondecision, lisas_score, efficiency, balanced, measures };
using Measures = std::array<std::optional<double>, measures>;

std::vector<double> correct_times(const Cell& cell) {
  std::vector<double> times;
  for (const auto& trial : cell)
    if (trial.correct) times.push_back(trial.time_s);
  return times;
}

EzMoments moments(const Cell& cell) {
  const auto times = correct_times(cell);
  EzMoments result;
  result.trials = static_cast<int>(cell.size());
  if (cell.empty()) return result;
  result.proportion_correct = static_cast<double>(times.size()) / static_cast<double>(cell.size());
  if (times.size() > 1) {
    result.mean_s = mean(times);
    result.variance_s2 = variance(times);
  }
  return result;
}

SharedEzResult diffusion(const Group& group) {
  std::vector<EzMoments> conditions;
  for (const auto& cell : group.cells) conditions.push_back(moments(cell));
  return shared_ez_diffusion(conditions);
}

Cell pooled(const Group& group) {
  Cell all;
  for (const auto& cell : group.cells) all.insert(all.end(), cell.begin(), cell.end());
  return all;
}

/// Computes the balanced integration score (BIS) of each condition: standardises the scores over the cells of
/// all conditions, then averages over the condition's cells.
void add_balanced(const std::vector<Group>& groups, std::vector<Measures>& result) {
  if (groups.size() < 2) return;
  std::vector<double> proportion, time;
  for (const auto& group : groups)
    for (const auto& cell : group.cells) {
      const auto times = correct_times(cell);
      if (times.empty()) return;
      proportion.push_back(static_cast<double>(times.size()) / static_cast<double>(cell.size()));
      time.push_back(mean(times));
    }
  const auto scores = balanced_integration(proportion, time);
  if (!scores) return;
  std::size_t next = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    double sum = 0;
    for (std::size_t i = 0; i < groups[g].cells.size(); ++i) sum += (*scores)[next++];
    result[g][balanced] = sum / static_cast<double>(groups[g].cells.size());
  }
}

std::vector<Measures> measure(const std::vector<Group>& groups) {
  std::vector<Measures> result(groups.size());
  Cell session;
  for (const auto& group : groups) {
    const auto all = pooled(group);
    session.insert(session.end(), all.begin(), all.end());
  }
  const auto session_times = correct_times(session);
  if (session_times.size() < 2) return result;
  const double error = 1 - static_cast<double>(session_times.size()) / static_cast<double>(session.size());
  const double sd_time = std::sqrt(variance(session_times)), sd_error = std::sqrt(error * (1 - error));
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto all = pooled(groups[g]);
    const auto right = correct_times(all);
    if (all.empty()) continue;
    const double p = static_cast<double>(right.size()) / static_cast<double>(all.size());
    std::vector<double> times;
    for (const auto& trial : all) times.push_back(trial.time_s);
    result[g][accuracy] = p;
    result[g][median] = quantile(std::move(times), 0.5);
    if (right.empty()) continue;
    result[g][lisas_score] = lisas(mean(right), 1 - p, sd_time, sd_error);
    result[g][efficiency] = inverse_efficiency(mean(right), p);
    if (const auto fitted = diffusion(groups[g]).parameters) {
      result[g][boundary] = fitted->boundary;
      result[g][nondecision] = fitted->nondecision_s;
    }
  }
  add_balanced(groups, result);
  return result;
}

std::vector<Group> drawn(const std::vector<Group>& groups, const random::Key& key) {
  random::Draws draws(key);
  auto result = groups;
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (std::size_t c = 0; c < groups[g].cells.size(); ++c)
      for (auto& trial : result[g].cells[c])
        trial = groups[g].cells[c][draws.below(groups[g].cells[c].size())];
  return result;
}

std::optional<Estimate> estimate(const std::optional<double>& value, std::vector<double> replicates,
                                 const TradeOptions& options) {
  if (!value || static_cast<double>(replicates.size()) < 0.95 * options.replicates) return std::nullopt;
  return Estimate{*value, percentile_interval(std::move(replicates), options.confidence)};
}

/// Computes the results of one condition that need no bootstrap. Returns the condition's trials, grouped by
/// difficulty.
Group collect(const std::vector<TrialRecord>& trials, const TradeOptions& options,
              InstructionResult& result) {
  std::vector<const TrialRecord*> scored;
  std::vector<double> times;
  for (const auto& trial : trials) {
    if (trial.type != TrialType::experimental || trial.instruction != result.instruction) continue;
    if (trial.outcome == Outcome::fault || trial.outcome == Outcome::aborted) continue;  // void
    ++result.presented;
    result.timeouts += trial.outcome == Outcome::timeout;
    result.anticipations += trial.outcome == Outcome::anticipation;
    if (trial.outcome != Outcome::answered || !trial.correct || !trial.response_time_s) continue;
    ++result.answered;
    scored.push_back(&trial);
    times.push_back(*trial.response_time_s);
  }
  const auto kept = keep_times(times, options.exclusion);
  std::map<double, Cell> cells;
  std::vector<bool> correct;
  std::vector<double> right;
  for (std::size_t i = 0; i < scored.size(); ++i) {
    if (!kept[i]) {
      ++result.excluded;
      continue;
    }
    const Scored entry{times[i], *scored[i]->correct};
    const double level = scored[i]->level ? std::abs(*scored[i]->level) : 0;
    cells[scored[i]->difficulty.value_or(level)].push_back(entry);
    result.times_s.push_back(entry.time_s);
    correct.push_back(entry.correct);
    if (entry.correct) right.push_back(entry.time_s);
  }
  result.correct = static_cast<int>(right.size());
  result.times = describe_times(result.times_s);
  result.correct_times = describe_times(right);
  result.caf = conditional_accuracy(result.times_s, correct, options.caf_bins);
  Group group;
  for (auto& [difficulty, cell] : cells) {
    group.difficulty.push_back(difficulty);
    group.cells.push_back(std::move(cell));
  }
  return group;
}

void fill_cells(const Group& group, InstructionResult& result, double confidence) {
  const auto fitted = diffusion(group);
  result.statements = fitted.statements;
  for (std::size_t i = 0; i < group.cells.size(); ++i) {
    DifficultyCell cell;
    cell.difficulty = group.difficulty[i];
    const auto times = correct_times(group.cells[i]);
    cell.answered = static_cast<int>(group.cells[i].size());
    cell.correct = static_cast<int>(times.size());
    cell.proportion_correct = static_cast<double>(cell.correct) / cell.answered;
    cell.accuracy = wilson(cell.correct, cell.answered, confidence);
    if (!times.empty()) cell.mean_correct_s = mean(times);
    if (fitted.parameters && cell.correct > 0) cell.drift = fitted.parameters->drift[i];
    result.cells.push_back(cell);
  }
  const int n = static_cast<int>(result.times_s.size());
  if (n > 0)
    result.proportion_correct =
        Estimate{static_cast<double>(result.correct) / n, wilson(result.correct, n, confidence)};
  if (result.timeouts > 0.05 * result.presented)
    result.statements.push_back(
        {"timeouts",
         texts::phrase("statement.timeouts",
                       {texts::plain(text::number(100.0 * result.timeouts / result.presented, 3))})});
  if (result.caf.empty())
    result.statements.push_back({"caf-too-few", texts::phrase("statement.caf_too_few")});
}

void set_estimates(InstructionResult& result, const Group& group, const Measures& values,
                   const std::vector<std::vector<double>>& replicates, const TradeOptions& options) {
  const auto of = [&](Measure which) { return estimate(values[which], replicates[which], options); };
  result.median_s = of(median);
  result.boundary = of(boundary);
  if (result.boundary) {
    const double reach = std::exp(normal_quantile(0.5 + options.confidence / 2) *
                                  diffusion(group).parameters->log_boundary_sd);
    result.boundary->interval = {*values[boundary] / reach, *values[boundary] * reach, options.confidence};
  }
  result.nondecision_s = of(nondecision);
  result.lisas_s = of(lisas_score);
  result.inverse_efficiency_s = of(efficiency);
  result.balanced = of(balanced);
  if (values[boundary] && !result.boundary) {
    for (auto& cell : result.cells) cell.drift.reset();
    result.statements.push_back({"ez-unstable", texts::phrase("statement.ez_unstable")});
  }
}

/// Returns the interval of `b - a` from the intervals of two independent estimates (MOVER; Donner & Zou
/// 2002).
Interval difference_interval(const Estimate& a, const Estimate& b) {
  const double gap = b.value - a.value;
  return {gap - std::hypot(b.value - b.interval.low, a.interval.high - a.value),
          gap + std::hypot(b.interval.high - b.value, a.value - a.interval.low), a.interval.confidence};
}

struct MeasureName {
  const char *name, *unit;
};
constexpr MeasureName kNames[measures] = {{"proportion correct", "proportion"},
                                          {"median response time", "s"},
                                          {"boundary", "(s = 0.1)"},
                                          {"time outside the decision", "s"},
                                          {"LISAS", "s"},
                                          {"inverse efficiency", "s"},
                                          {"BIS", "SD"}};

/// The measures of each condition: for the session itself, and for each bootstrap replicate of the session.
struct Sessions {
  std::vector<Measures> values;
  std::vector<std::vector<Measures>> replicates;

  std::vector<std::vector<double>> of(std::size_t group) const {
    std::vector<std::vector<double>> all(measures);
    for (const auto& again : replicates)
      for (int which = 0; which < measures; ++which)
        if (again[group][which]) all[which].push_back(*again[group][which]);
    return all;
  }

  std::optional<Estimate> difference(std::size_t a, std::size_t b, int which,
                                     const TradeOptions& options) const {
    std::vector<double> gaps;
    for (const auto& again : replicates)
      if (again[a][which] && again[b][which]) gaps.push_back(*again[b][which] - *again[a][which]);
    std::optional<double> gap;
    if (values[a][which] && values[b][which]) gap = *values[b][which] - *values[a][which];
    return estimate(gap, std::move(gaps), options);
  }
};

void add_differences(const Sessions& sessions, const TradeOptions& options, Trade& trade) {
  for (std::size_t a = 0; a < trade.instructions.size(); ++a)
    for (std::size_t b = a + 1; b < trade.instructions.size(); ++b) {
      const auto &first = trade.instructions[a], &second = trade.instructions[b];
      for (int which = 0; which < measures; ++which) {
        auto difference = sessions.difference(a, b, which, options);
        if (which == boundary && difference && first.boundary && second.boundary)
          difference->interval = difference_interval(*first.boundary, *second.boundary);
        trade.differences.push_back(
            {first.instruction, second.instruction, kNames[which].name, kNames[which].unit, difference});
      }
    }
}

}  // namespace

Trade trade(const std::vector<TrialRecord>& trials, const TradeOptions& options) {
  Trade result;
  std::vector<Group> groups;
  for (const auto& name : conditions_of(trials, options.order)) {
    auto& entry = result.instructions.emplace_back();
    entry.instruction = name;
    groups.push_back(collect(trials, options, entry));
    fill_cells(groups.back(), entry, options.confidence);
  }
  Sessions sessions{measure(groups), {}};
  for (int i = 0; i < options.replicates; ++i)
    sessions.replicates.push_back(
        measure(drawn(groups, {options.seed, random::Stream::bootstrap, 1000, 0, i})));
  for (std::size_t g = 0; g < groups.size(); ++g)
    set_estimates(result.instructions[g], groups[g], sessions.values[g], sessions.of(g), options);
  add_differences(sessions, options, result);
  return result;
}

}  // namespace turnpoint::analysis

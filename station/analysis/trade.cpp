#include "station/analysis/trade.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

#include "station/analysis/course.hpp"
#include "station/analysis/diffusion.hpp"
#include "station/analysis/proportion.hpp"
#include "station/analysis/quantile.hpp"
#include "station/analysis/student.hpp"
#include "station/core/draws.hpp"
#include "station/core/number.hpp"

namespace turnpoint::analysis {

bool is_proportion(const std::string& measure) {
  return measure == kCorrect || measure == kRocArea || measure.starts_with(kBinMeasure);
}

namespace {

constexpr double kMisfit = 0.05;  // a smaller share of as bad sessions is said to be a misfit

struct Scored {
  double time_s;
  bool correct;
};
using Cell = std::vector<Scored>;

/// The trials of one condition, by difficulty.
struct Group {
  std::vector<double> difficulty;
  std::vector<Cell> answered;  ///< all answers
  std::vector<Cell> cells;     ///< those whose times the exclusion rule keeps
  std::vector<DiffusionTrial> decisions;
  std::vector<bool> late_half;  ///< of each decision: whether it is in the second half of its block
  std::optional<DiffusionEstimates> diffusion;
};

enum Measure { accuracy, median, lisas_score, efficiency, measures };
using Measures = std::array<std::optional<double>, measures>;

std::vector<double> correct_times(const Cell& cell) {
  std::vector<double> times;
  for (const auto& trial : cell)
    if (trial.correct) times.push_back(trial.time_s);
  return times;
}

/// Applies the exclusion rule to all answers of a condition together.
void keep(Group& group, const TimeExclusion& rule) {
  std::vector<double> times;
  for (const auto& cell : group.answered)
    for (const auto& answer : cell) times.push_back(answer.time_s);
  const auto kept = keep_times(times, rule);
  group.cells.assign(group.answered.size(), {});
  std::size_t next = 0;
  for (std::size_t i = 0; i < group.answered.size(); ++i)
    for (const auto& answer : group.answered[i])
      if (kept[next++]) group.cells[i].push_back(answer);
}

Cell pooled(const Group& group) {
  Cell all;
  for (const auto& cell : group.cells) all.insert(all.end(), cell.begin(), cell.end());
  return all;
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
  }
  return result;
}

std::vector<Group> drawn(const std::vector<Group>& groups, const TimeExclusion& rule,
                         const core::DrawKey& key) {
  core::Draws draws(key);
  std::vector<Group> result(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const auto& cell : groups[g].answered) {
      auto& again = result[g].answered.emplace_back();
      for (std::size_t i = 0; i < cell.size(); ++i) again.push_back(cell[draws.below(cell.size())]);
    }
    keep(result[g], rule);
  }
  return result;
}

std::optional<Estimate> estimate(const std::optional<double>& value, std::vector<double> replicates,
                                 const TradeOptions& options) {
  if (!value || static_cast<double>(replicates.size()) < 0.95 * options.replicates) return std::nullopt;
  return Estimate{*value, percentile_interval(std::move(replicates), options.confidence)};
}

/// The p value of a difference whose draws these are.
double p_of_draws(const std::vector<double>& gaps) {
  const auto low = std::count_if(gaps.begin(), gaps.end(), [](double gap) { return gap <= 0; }),
             high = std::count_if(gaps.begin(), gaps.end(), [](double gap) { return gap >= 0; });
  const auto fewer = static_cast<double>(std::min(low, high));
  const double counted = std::min(1.0, 2 * (fewer + 1) / (static_cast<double>(gaps.size()) + 1));
  constexpr double kFewestDraws = 10;
  const double sd = std::sqrt(variance(gaps));
  if (fewer >= kFewestDraws || !(sd > 0)) return counted;
  return std::min(counted, 2 * normal_cdf(-std::fabs(mean(gaps)) / sd));
}

/// The difference of two proportions, second minus first, with Newcombe's hybrid interval (1998) and the p
/// value of the interval that ends at 0.
Estimate proportion_difference(const Proportion& first, const Proportion& second, double confidence) {
  const auto at = [&](double share) {
    return difference_of({first.value, wilson(first.right, first.trials, share)},
                         {second.value, wilson(second.right, second.trials, share)});
  };
  auto found = at(confidence);
  double low = 0, high = 1 - 1e-12;  // the confidence at which an end of the interval is 0
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    const auto interval = at(middle).interval;
    (interval.low > 0 || interval.high < 0 ? low : high) = middle;
  }
  found.p = found.value == 0 ? 1 : 1 - high;
  return found;
}

/// Computes the results of one condition that need no bootstrap. Returns the condition's trials, grouped by
/// difficulty.
Group collect(const std::vector<TrialRecord>& trials, const TradeOptions& options,
              InstructionResult& result) {
  const auto difficulty_of = [](const TrialRecord& trial) {
    return trial.difficulty.value_or(trial.level ? std::abs(*trial.level) : 0);
  };
  std::map<double, Cell> cells;
  struct Decision {
    DiffusionTrial trial;
    bool late_half;
  };
  std::map<double, std::vector<Decision>> decisions;
  std::map<int, std::pair<int, int>> block_ends;  // numbers of the first and the last trial
  for (const auto& trial : trials) {
    auto [end, added] = block_ends.try_emplace(trial.block_index, trial.trial_index, trial.trial_index);
    end->second.second = trial.trial_index;
  }
  std::vector<double> times;
  std::vector<bool> correct;
  for (const auto& trial : trials) {
    if (trial.type != TrialType::experimental || trial.instruction != result.instruction) continue;
    if (trial.outcome == Outcome::fault || trial.outcome == Outcome::aborted) continue;  // void
    result.deadline_s =
        result.presented == 0 || result.deadline_s == trial.deadline_s ? trial.deadline_s : std::nullopt;
    ++result.presented;
    result.timeouts += trial.outcome == Outcome::timeout;
    result.anticipations += trial.outcome == Outcome::anticipation;
    const double difficulty = difficulty_of(trial);
    const auto [first, last] = block_ends[trial.block_index];
    const bool late_half = 2 * trial.trial_index > first + last;
    DiffusionTrial decision;
    decision.deadline_s = trial.deadline_s;
    decision.early_s = trial.anticipation_s;
    if (trial.outcome == Outcome::timeout && trial.deadline_s) {
      decision.outcome = DiffusionTrial::Outcome::late;
      decision.time_s = *trial.deadline_s;
      decisions[difficulty].push_back({decision, late_half});
    } else if (trial.outcome == Outcome::anticipation && trial.anticipation_s > 0) {
      decision.outcome = DiffusionTrial::Outcome::early;
      decision.time_s = trial.anticipation_s;
      decisions[difficulty].push_back({decision, late_half});
    }
    if (trial.outcome != Outcome::answered || !trial.correct || !trial.response_time_s) continue;
    ++result.answered;
    cells[difficulty].push_back({*trial.response_time_s, *trial.correct});
    times.push_back(*trial.response_time_s);
    correct.push_back(*trial.correct);
    decision.correct = *trial.correct;
    decision.time_s = *trial.response_time_s;
    decisions[difficulty].push_back({decision, late_half});
  }
  Group group;
  for (auto& [difficulty, cell] : cells) {
    group.difficulty.push_back(difficulty);
    for (auto& [decision, late_half] : decisions[difficulty]) {
      decision.difficulty = group.answered.size();
      group.decisions.push_back(decision);
      group.late_half.push_back(late_half);
    }
    group.answered.push_back(std::move(cell));
  }
  keep(group, options.exclusion);
  const auto kept = keep_times(times, options.exclusion);
  std::vector<double> right;
  std::vector<bool> kept_correct;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!kept[i]) {
      ++result.excluded;
      continue;
    }
    result.times_s.push_back(times[i]);
    kept_correct.push_back(correct[i]);
    if (correct[i]) right.push_back(times[i]);
  }
  result.correct = static_cast<int>(right.size());
  result.times = describe_times(result.times_s);
  result.correct_times = describe_times(right);
  result.caf = conditional_accuracy(result.times_s, kept_correct, options.caf_bins);
  return group;
}

/// Computes what the trials of a condition were worth to the participant.
void add_points(const std::vector<TrialRecord>& trials, InstructionResult& result) {
  std::vector<double> points, minutes;
  for (const auto& trial : trials) {
    if (trial.type != TrialType::experimental || trial.instruction != result.instruction || !trial.points)
      continue;
    points.push_back(*trial.points);
    minutes.push_back(trial.duration_s / 60);
  }
  result.points = student_mean(points);
  result.points_per_minute = student_ratio(points, minutes);
}

/// The boundary in the second half of the blocks minus that in the first half.
std::optional<Estimate> late_boundary(const Group& group, int stream, const TradeOptions& options) {
  std::vector<DiffusionTrial> halves[2];
  for (std::size_t i = 0; i < group.decisions.size(); ++i)
    halves[group.late_half[i]].push_back(group.decisions[i]);
  DiffusionOptions how;
  how.confidence = options.confidence;
  std::vector<double> gaps;
  for (const int late : {0, 1}) {
    const auto fit =
        fit_diffusion(halves[late], group.difficulty.size(), options.seed, 100 * (late + 1) + stream, how);
    if (!fit.estimates) return std::nullopt;
    gaps.resize(fit.estimates->draws.size());
    for (std::size_t i = 0; i < gaps.size(); ++i)
      gaps[i] += (late ? 1 : -1) * fit.estimates->draws[i].boundary;
  }
  const double middle = quantile(gaps, 0.5);
  return Estimate{middle, percentile_interval(std::move(gaps), options.confidence)};
}

/// Fits the diffusion model, and describes the answers of each difficulty.
void fill_cells(Group& group, InstructionResult& result, int stream, const TradeOptions& options) {
  DiffusionOptions how;
  how.confidence = options.confidence;
  auto fitted = fit_diffusion(group.decisions, group.difficulty.size(), options.seed, stream, how);
  result.statements = std::move(fitted.statements);
  group.diffusion = std::move(fitted.estimates);
  if (group.diffusion) {
    result.boundary = group.diffusion->boundary;
    result.nondecision_s = group.diffusion->nondecision_s;
    result.contaminants = group.diffusion->contaminants;
    result.effective_draws = group.diffusion->effective_draws;
    std::vector<double> drifts;
    for (const auto& draw : group.diffusion->draws) drifts.push_back(mean(draw.drift));
    const double middle = quantile(drifts, 0.5);
    result.drift = Estimate{middle, percentile_interval(std::move(drifts), options.confidence)};
    result.difficulties = group.difficulty;
    result.check = check_diffusion(group.decisions, *group.diffusion, options.seed, stream);
    if (options.halves) result.late_boundary = late_boundary(group, stream, options);
  }
  for (std::size_t i = 0; i < group.cells.size(); ++i) {
    if (group.cells[i].empty()) continue;
    DifficultyCell cell;
    cell.difficulty = group.difficulty[i];
    const auto times = correct_times(group.cells[i]);
    cell.answered = static_cast<int>(group.cells[i].size());
    cell.correct = static_cast<int>(times.size());
    cell.proportion_correct = static_cast<double>(cell.correct) / cell.answered;
    cell.accuracy = wilson(cell.correct, cell.answered, options.confidence);
    if (!times.empty()) cell.mean_correct_s = mean(times);
    if (group.diffusion) cell.drift = group.diffusion->drift[i];
    result.cells.push_back(cell);
  }
  const int n = static_cast<int>(result.times_s.size());
  if (n > 0)
    result.proportion_correct =
        Estimate{static_cast<double>(result.correct) / n, wilson(result.correct, n, options.confidence)};
  if (result.timeouts > 0.05 * result.presented)
    result.statements.push_back(
        {"timeouts",
         core::phrase("statement.timeouts",
                      {core::plain(core::number(100.0 * result.timeouts / result.presented, 3))})});
  if (result.caf.empty()) result.statements.push_back({"caf-too-few", core::phrase("statement.caf_too_few")});
}

void set_estimates(InstructionResult& result, const Measures& values,
                   const std::vector<std::vector<double>>& replicates, const TradeOptions& options) {
  const auto of = [&](Measure which) { return estimate(values[which], replicates[which], options); };
  result.median_s = of(median);
  result.lisas_s = of(lisas_score);
  result.inverse_efficiency_s = of(efficiency);
}

struct MeasureName {
  const char *name, *unit;
};
constexpr MeasureName kNames[measures] = {
    {kCorrect, "proportion"}, {kMedianTime, "s"}, {kLisas, "s"}, {kInverseEfficiency, "s"}};

/// The difference of one parameter of two diffusion fits, second minus first: the median and a central
/// interval of the differences between their draws.
template <typename Of>
std::optional<Estimate> diffusion_difference(const Group& first, const Group& second, double confidence,
                                             const Of& of) {
  if (!first.diffusion || !second.diffusion) return std::nullopt;
  std::vector<double> gaps;
  const auto &a = first.diffusion->draws, &b = second.diffusion->draws;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    gaps.push_back(of(second, b[i]) - of(first, a[i]));
  const double middle = quantile(gaps, 0.5), p = p_of_draws(gaps);
  return Estimate{middle, percentile_interval(std::move(gaps), confidence), p};
}

void add_diffusion_differences(const Group& first, const Group& second, const TradeOptions& options,
                               const InstructionResult& a, const InstructionResult& b,
                               std::vector<Difference>& differences) {
  const auto add = [&](const char* measure, const char* unit, const auto& of) {
    differences.push_back({a.instruction, b.instruction, measure, unit,
                           diffusion_difference(first, second, options.confidence, of)});
  };
  add(kBoundary, "s = 0.1", [](const Group&, const DiffusionDraw& draw) { return draw.boundary; });
  add(kNondecision, "s", [](const Group&, const DiffusionDraw& draw) { return draw.nondecision_s; });
  std::vector<double> shared;
  std::set_intersection(first.difficulty.begin(), first.difficulty.end(), second.difficulty.begin(),
                        second.difficulty.end(), std::back_inserter(shared));
  if (shared.empty()) {
    differences.push_back({a.instruction, b.instruction, kDrift, "s = 0.1", std::nullopt});
    return;
  }
  add(kDrift, "s = 0.1", [&shared](const Group& group, const DiffusionDraw& draw) {
    double sum = 0;
    for (std::size_t i = 0; i < group.difficulty.size(); ++i)
      if (std::binary_search(shared.begin(), shared.end(), group.difficulty[i])) sum += draw.drift[i];
    return sum / static_cast<double>(shared.size());
  });
}

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
    if (gaps.empty()) return std::nullopt;
    const double p = p_of_draws(gaps);
    auto found = estimate(gap, std::move(gaps), options);
    if (found) found->p = p;
    return found;
  }
};

void add_differences(const Sessions& sessions, const std::vector<Group>& groups, const TradeOptions& options,
                     Trade& trade) {
  for (std::size_t a = 0; a < trade.instructions.size(); ++a)
    for (std::size_t b = a + 1; b < trade.instructions.size(); ++b) {
      const auto &first = trade.instructions[a], &second = trade.instructions[b];
      for (int which = 0; which < measures; ++which) {
        auto difference = sessions.difference(a, b, which, options);
        if (which == accuracy && difference && !first.times_s.empty() && !second.times_s.empty())
          difference = proportion_difference(
              proportion(first.correct, static_cast<int>(first.times_s.size())),
              proportion(second.correct, static_cast<int>(second.times_s.size())), options.confidence);
        trade.differences.push_back(
            {first.instruction, second.instruction, kNames[which].name, kNames[which].unit, difference});
        if (which == median)
          add_diffusion_differences(groups[a], groups[b], options, first, second, trade.differences);
      }
      for (std::size_t i = 0; i < std::min(first.caf.size(), second.caf.size()); ++i)
        trade.differences.push_back(
            {first.instruction, second.instruction,
             kBinMeasure + std::to_string(i + 1) + " of " + std::to_string(first.caf.size()), "proportion",
             proportion_difference(proportion(first.caf[i].correct, first.caf[i].trials),
                                   proportion(second.caf[i].correct, second.caf[i].trials),
                                   options.confidence)});
      for (const auto& [measure, unit, value] :
           {std::tuple{kPoints, "points", &InstructionResult::points},
            {kPointsPerMinute, "points/min", &InstructionResult::points_per_minute}})
        if (first.*value && second.*value)
          trade.differences.push_back({first.instruction, second.instruction, measure, unit,
                                       difference_of(*(first.*value), *(second.*value))});
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
    entry.post_error_s = post_error_slowing(trials, name);
    entry.repetition = repetition(trials, name);
    add_points(trials, entry);
    fill_cells(groups.back(), entry, static_cast<int>(groups.size()), options);
  }
  std::vector<const DiffusionCheck*> checks;
  for (const auto& entry : result.instructions)
    if (entry.check) checks.push_back(&*entry.check);
  result.model_p = share_as_bad(checks);
  if (result.model_p && *result.model_p < kMisfit)
    result.statements.push_back({"diffusion-misfit", core::phrase("statement.diffusion_misfit")});
  Sessions sessions{measure(groups), {}};
  for (int i = 0; i < options.replicates; ++i)
    sessions.replicates.push_back(
        measure(drawn(groups, options.exclusion, {options.seed, core::Stream::bootstrap, 1000, 0, i})));
  for (std::size_t g = 0; g < groups.size(); ++g)
    set_estimates(result.instructions[g], sessions.values[g], sessions.of(g), options);
  add_differences(sessions, groups, options, result);
  return result;
}

}  // namespace turnpoint::analysis

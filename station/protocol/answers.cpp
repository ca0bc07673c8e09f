#include "station/protocol/answers.hpp"

#include <algorithm>
#include <cmath>

#include "station/protocol/expression.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

namespace {

int index_of(const Task& task, const std::string& id) {
  for (std::size_t i = 0; i < task.choices.size(); ++i)
    if (task.choices[i].id == id) return static_cast<int>(i);
  return -1;
}

/// Returns the index of the choice that is right at this level; -1 if no choice is right.
int right_at(const Protocol& protocol, const std::string& level, double value) {
  auto factors = any_factors(protocol);
  factors[level] = value;
  for (const auto& [id, comparison] : protocol.task.correct_answer)
    if (holds(comparison, factors)) return index_of(protocol.task, id);
  return -1;
}

/// Returns the levels of a source of trials. A staircase may reach any level between its limits; a few levels
/// in between represent them all.
std::vector<double> levels_of(const Source& source) {
  if (!source.spec || !source.spec->min || !source.spec->max) return source.levels;
  constexpr int steps = 100;
  const double low = *source.spec->min, high = *source.spec->max;
  std::vector<double> levels;
  for (int i = 0; i <= steps; ++i) levels.push_back(low + i * (high - low) / steps);
  return levels;
}

/// Returns for each choice the mean of the presented levels at which this choice is right. Empty if the right
/// choice depends on other factors too, if a choice is never right, or if two choices have the same mean.
std::vector<double> categories(const Protocol& protocol, const std::string& level) {
  const auto& task = protocol.task;
  for (const auto& [id, comparison] : task.correct_answer)
    for (const auto* side : {&comparison.left, &comparison.right})
      for (const auto& name : factors_in(*side))
        if (name != level) return {};
  std::vector<double> sums(task.choices.size(), 0.0), counts = sums;
  for (const auto& source : sources_of(protocol)) {
    if (source.level != level) continue;
    for (const double value : source.levels)
      if (const int right = right_at(protocol, level, value); right >= 0) {
        const auto choice = static_cast<std::size_t>(right);
        sums[choice] += value, counts[choice] += 1;
      }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    if (counts[i] == 0) return {};
    sums[i] /= counts[i];
    if (std::find(sums.begin(), sums.begin() + static_cast<std::ptrdiff_t>(i), sums[i]) !=
        sums.begin() + static_cast<std::ptrdiff_t>(i))
      return {};
  }
  return sums;
}

/// Returns the rule for a task with two answers; empty if the sign of the level does not decide which answer
/// is right.
std::optional<AnswerRule> two_answers(const Protocol& protocol, const std::string& level, double low,
                                      double high) {
  const int below = low < 0 ? right_at(protocol, level, low) : -1;
  const int above = high > 0 ? right_at(protocol, level, high) : -1;
  const int at_zero = low <= 0 && high >= 0 ? right_at(protocol, level, 0) : -1;
  if (below >= 0 && above >= 0 && below != above) return AnswerRule{AnswerKind::side, above};
  const int off = std::max(below, above);
  if (at_zero >= 0 && off >= 0 && off != at_zero) return AnswerRule{AnswerKind::presence, off};
  return std::nullopt;
}

}  // namespace

AnswerRule answer_rule(const Protocol& protocol, const std::string& level) {
  const auto& task = protocol.task;
  if (task.kind == TaskKind::same_different) return {AnswerKind::presence, index_of(task, "different")};
  const auto* factor = find_factor(protocol.factors, level);
  if (task.kind != TaskKind::single_interval || task.correct_answer.size() < 2 || !factor) return {};
  const auto ends = span(*factor);
  if (!ends) return {};
  if (task.correct_answer.size() == 2)
    if (const auto rule = two_answers(protocol, level, ends->first, ends->second)) return *rule;
  auto found = categories(protocol, level);
  if (found.empty()) return {};
  return {AnswerKind::category, 1, std::move(found)};
}

bool two_sided(const Protocol& protocol, const std::string& level) {
  const auto* factor = find_factor(protocol.factors, level);
  const auto ends = factor ? span(*factor) : std::nullopt;
  return ends && ends->first < 0 && ends->second > 0;
}

bool explored(const Task& task) {
  return (task.kind == TaskKind::single_interval && task.standard.empty()) ||
         task.kind == TaskKind::adjustment;
}

std::optional<StimulusEnd> stimulus_end(const Protocol& protocol) {
  const auto& task = protocol.task;
  const auto whole = task.duration_s ? task.duration_s : protocol.timing.explore_s;
  const auto zero = protocol.timing.response_zero;
  if (zero == ResponseZero::interval_off) return StimulusEnd{};
  if (!whole || task.intervals.empty()) return std::nullopt;
  if (zero == ResponseZero::go_cue) return StimulusEnd{*whole, *whole};
  const auto scenes = task.intervals.back().size();
  if (zero != ResponseZero::change || scenes < 2) return std::nullopt;
  const double even = *whole / static_cast<double>(scenes);
  const auto change = task.foreperiod_s.value_or(Distribution{even, even});
  return StimulusEnd{*whole - change.high, *whole - change.low};
}

std::optional<double> accepted(const ValueAnswer& answer, double given) {
  const double scale = std::pow(10.0, answer.decimals);
  const double value = std::round(given * scale) / scale;
  if (!(value >= answer.low && value <= answer.high)) return std::nullopt;
  if (answer.typed && std::fabs(given - value) > 1e-6 / scale) return std::nullopt;
  return value;
}

double middle_level(const Protocol& protocol, const std::string& level) {
  const bool decibel = level.ends_with("_dB");
  std::vector<double> by_procedures, by_blocks;
  for (const auto& source : sources_of(protocol)) {
    if (source.level != level) continue;
    for (const double value : levels_of(source))
      if (decibel || value != 0)
        (source.spec ? by_procedures : by_blocks).push_back(decibel ? value : std::fabs(value));
  }
  auto& all = by_procedures.empty() ? by_blocks : by_procedures;
  if (all.empty()) return 1;
  std::sort(all.begin(), all.end());
  return 0.5 * (all[(all.size() - 1) / 2] + all[all.size() / 2]);
}

}  // namespace turnpoint::protocol

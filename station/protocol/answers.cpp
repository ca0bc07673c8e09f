#include "station/protocol/answers.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "station/core/median.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/orders.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

std::string scene_of(const Task& task, int number) {
  const auto& own = task.intervals.at(static_cast<std::size_t>(number));
  const auto& other = task.intervals.at(1 - static_cast<std::size_t>(number));
  for (const auto& name : own)
    if (std::find(other.begin(), other.end(), name) == other.end()) return name;
  return own.empty() ? "" : own.front();
}

namespace {

int index_of(const Task& task, const std::string& id) {
  for (std::size_t i = 0; i < task.choices.size(); ++i)
    if (task.choices[i].id == id) return static_cast<int>(i);
  // the comparisons of 2ifc are about scenes
  for (std::size_t i = 0; i < task.intervals.size(); ++i)
    if (task.kind == TaskKind::two_interval && scene_of(task, static_cast<int>(i)) == id)
      return static_cast<int>(i);
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

/// Number of steps in which a factor's range is searched for the levels at which the right answer changes.
constexpr int kSteps = 64;

/// The answers that are right along a range of levels: each differs from the one before it. Levels at which
/// no answer is right, and single levels at which another answer is right, belong to none of them.
struct Stretches {
  std::vector<int> right;    ///< indices of choices
  std::vector<double> cuts;  ///< the levels between them
};

Stretches stretches(const Protocol& protocol, const std::string& level, double low, double high) {
  Stretches found;
  double last = low;
  for (int i = 0; i <= kSteps; ++i) {
    // off the round levels, at which a comparison such as `level == 0` may hold
    const double at = low + (high - low) * (i + (i == 0 ? 1e-4 : i == kSteps ? -1e-4 : 1e-5)) / kSteps;
    const int right = right_at(protocol, level, at);
    if (right < 0) continue;
    if (!found.right.empty() && found.right.back() != right) {
      // the last level at which the one answer is right, and the first at which the other is
      const auto edge = [&](double from, double to, int answer) {
        for (int step = 0; step < 60; ++step) {
          const double middle = 0.5 * (from + to);
          (right_at(protocol, level, middle) == answer ? from : to) = middle;
        }
        return 0.5 * (from + to);
      };
      const double cut = 0.5 * (edge(last, at, found.right.back()) + edge(at, last, right));
      // a level that people write has few digits
      const double unit = 1e-9 * std::max(std::fabs(low), std::fabs(high));
      found.cuts.push_back(std::round(cut / unit) * unit + 0.0);
    }
    if (found.right.empty() || found.right.back() != right) found.right.push_back(right);
    last = at;
  }
  return found;
}

/// True if the trials of one of the answers all have the level 0: then there was no signal.
bool only_zero(const Protocol& protocol, const std::string& level, int answer) {
  bool any = false;
  for (const auto& source : sources_of(protocol)) {
    if (source.level != level || source.block->practice) continue;
    for (const double value : levels_of(source))
      if (right_at(protocol, level, value) == answer) {
        if (value != 0) return false;
        any = true;
      }
  }
  return any;
}

/// Returns the rule for a task with two answers; empty if the level does not decide which answer is right.
std::optional<AnswerRule> two_answers(const Protocol& protocol, const std::string& level, double low,
                                      double high) {
  const auto found = stretches(protocol, level, low, high);
  const auto& right = found.right;
  AnswerRule rule;
  if (right.size() == 1) {
    const int at_zero = low <= 0 && high >= 0 ? right_at(protocol, level, 0) : -1;
    if (at_zero < 0 || at_zero == right.front()) return std::nullopt;
    rule.kind = AnswerKind::presence, rule.positive = right.front();
    return rule;
  }
  if (right.size() == 2) {
    for (const int answer : right)
      if (only_zero(protocol, level, answer)) {
        rule.kind = AnswerKind::presence, rule.positive = right[0] + right[1] - answer;
        return rule;
      }
    rule.kind = AnswerKind::side, rule.positive = right.back(), rule.cut = found.cuts.front();
    return rule;
  }
  // one answer is right near zero, the other one far from it on both sides
  const auto& cuts = found.cuts;
  if (right.size() == 3 && std::fabs(cuts[0] + cuts[1]) < 1e-6 * (cuts[1] - cuts[0])) {
    rule.size = true;
    rule.kind = only_zero(protocol, level, right[1]) ? AnswerKind::presence : AnswerKind::side;
    rule.positive = right[2], rule.cut = rule.kind == AnswerKind::side ? cuts[1] : 0;
    return rule;
  }
  return std::nullopt;
}

/// The rule for two answers of which none is right or wrong: how often one of them is given has a PSE. It is
/// the answer that a procedure tracks, or the second one.
std::optional<AnswerRule> choice_rule(const Protocol& protocol, const std::string& level, double low,
                                      double high) {
  AnswerRule rule;
  rule.kind = AnswerKind::side;
  rule.cut = low < 0 && high > 0 ? 0 : 0.5 * (low + high);
  for (const auto& spec : protocol.procedures) {
    if (spec.level != level) continue;
    if (spec.signal_detection)
      return std::nullopt;  // an answer that means "yes", and trials without a signal
    if (!spec.tracks.empty()) rule.positive = index_of(protocol.task, spec.tracks);
  }
  return rule;
}

}  // namespace

AnswerRule answer_rule(const Protocol& protocol, const std::string& level) {
  const auto& task = protocol.task;
  if (task.kind == TaskKind::same_different) return {AnswerKind::presence, index_of(task, "different")};
  const auto* factor = find_factor(protocol.factors, level);
  const bool scenes = task.kind == TaskKind::two_interval && !task.correct_answer.empty();
  if ((task.kind != TaskKind::single_interval && !scenes) || judges(task) || !factor) return {};
  const auto ends = span(*factor);
  if (!ends) return {};
  if (task.correct_answer.empty() && task.choices.size() == 2)
    return choice_rule(protocol, level, ends->first, ends->second).value_or(AnswerRule{});
  if (task.correct_answer.size() < 2) return {};
  if (task.correct_answer.size() == 2)
    if (const auto rule = two_answers(protocol, level, ends->first, ends->second)) return *rule;
  if (scenes) return {};
  auto found = categories(protocol, level);
  if (found.empty()) return {};
  return {AnswerKind::category, 1, std::move(found), 0, false};
}

AnswerRule answer_rule_of(const Protocol& protocol, const std::string& level) {
  for (const auto& meaning : protocol.meanings)
    if (meaning.level == level) return meaning.rule;
  return answer_rule(protocol, level);
}

bool two_sided(const Protocol& protocol, const std::string& level) {
  const auto* factor = find_factor(protocol.factors, level);
  const auto ends = factor ? span(*factor) : std::nullopt;
  return ends && ends->first < 0 && ends->second > 0;
}

int answer_count(const Task& task) {
  return static_cast<int>(task.choices.size()) + (task.unsure.empty() ? 0 : 1);
}

std::string answer_id(const Task& task, int index) {
  if (index < 0 || index >= answer_count(task)) return "";
  const auto place = static_cast<std::size_t>(index);
  return place < task.choices.size() ? task.choices[place].id : kUnsure;
}

std::optional<int> answer_index(const Task& task, const std::string& id) {
  for (int i = 0; i < answer_count(task); ++i)
    if (answer_id(task, i) == id) return i;
  return std::nullopt;
}

procedure::Answer learned_from(const procedure::Spec& spec, const std::string& response,
                               const std::optional<bool>& correct) {
  if (spec.guess_rate && response == kUnsure) return procedure::Answer::unsure;
  const bool one = spec.tracks.empty() ? correct.value_or(false) : response == spec.tracks;
  return one ? procedure::Answer::one : procedure::Answer::zero;
}

std::vector<Part> parts_of(const Task& task, const std::vector<std::string>& interval) {
  if (interval.size() == 1)
    if (const auto named = task.parts.find(interval.front()); named != task.parts.end()) return named->second;
  std::vector<Part> one(1);
  one.front().scenes = interval;
  return one;
}

std::vector<std::vector<Part>> parts_of_trial(const Task& task,
                                              const std::vector<std::vector<std::string>>& intervals) {
  std::vector<std::vector<Part>> all;
  for (const auto& interval : intervals) all.push_back(parts_of(task, interval));
  if (task.before.empty() || all.empty() || all.front().empty()) return all;
  auto& silences_s = all.front().front().silences_s;
  silences_s.insert(silences_s.begin(), task.before_silences_s.begin(), task.before_silences_s.end());
  all.front().insert(all.front().begin(), task.before.begin(), task.before.end());
  return all;
}

std::vector<Part> parts_of(const Task& task) {
  std::vector<Part> all = task.before;
  const auto add = [&](const std::vector<std::string>& interval) {
    for (auto& part : parts_of(task, interval)) all.push_back(std::move(part));
  };
  for (const auto* name : {&task.standard, &task.target})
    if (!name->empty()) add({*name});
  for (const auto& interval : task.intervals) add(interval);
  return all;
}

std::vector<Linear> stimulus_times(const Task& task) {
  std::vector<Linear> times;
  for (const auto* time : {&task.duration_s, &task.gap_s})
    if (*time) times.push_back(**time);
  if (task.foreperiod_s && task.foreperiod_s->expression) times.push_back(*task.foreperiod_s->expression);
  for (const auto& part : parts_of(task)) {
    if (part.duration_s) times.push_back(*part.duration_s);
    times.insert(times.end(), part.silences_s.begin(), part.silences_s.end());
  }
  times.insert(times.end(), task.before_silences_s.begin(), task.before_silences_s.end());
  return times;
}

const Linear* length_of(const Task& task, const Part& part) {
  return part.duration_s ? &*part.duration_s : task.duration_s ? &*task.duration_s : nullptr;
}

std::pair<double, double> length_range_s(const Protocol& protocol, const Part& part) {
  const auto* length = length_of(protocol.task, part);
  const double explored_s = protocol.timing.explore_s.value_or(0);
  auto [low, high] = length ? bounds(*length, protocol.factors) : std::pair(explored_s, explored_s);
  if (part.first_s) low = std::min(low, *part.first_s), high = std::max(high, *part.first_s);
  return {low, high};
}

bool explored(const Task& task) {
  if (task.kind == TaskKind::adjustment) return true;
  if (task.kind != TaskKind::single_interval || !task.standard.empty() || task.intervals.empty())
    return task.kind == TaskKind::single_interval && task.standard.empty() && !task.duration_s;
  const auto parts = parts_of(task, task.intervals.back());
  return parts.empty() ? !task.duration_s : length_of(task, parts.back()) == nullptr;
}

std::vector<Part> last_parts(const Task& task) {
  std::set<std::vector<std::string>> known;
  std::vector<Part> last;
  for (const auto& order : orders_of(task)) {
    if (order.intervals.empty() || !known.insert(order.intervals.back()).second) continue;
    const auto parts = parts_of(task, order.intervals.back());
    if (!parts.empty()) last.push_back(parts.back());
  }
  return last;
}

namespace {

/// The smallest range that contains both.
StimulusEnd joined(const StimulusEnd& a, const StimulusEnd& b) {
  return {std::min(a.earliest_s, b.earliest_s), std::max(a.latest_s, b.latest_s)};
}

/// The same as stimulus_end(), if this part is the last one.
std::optional<StimulusEnd> end_of(const Protocol& protocol, const Part& part, const Factors& factors) {
  const auto& task = protocol.task;
  const auto* length = length_of(task, part);
  const auto whole = length ? std::optional(evaluate(*length, factors)) : protocol.timing.explore_s;
  if (!whole) return std::nullopt;
  if (protocol.timing.response_zero == ResponseZero::go_cue) return StimulusEnd{*whole, *whole};
  const auto scenes = part.scenes.size();
  if (protocol.timing.response_zero != ResponseZero::change || scenes < 2) return std::nullopt;
  const double even = *whole / static_cast<double>(scenes);
  auto change = task.foreperiod_s.value_or(Distribution{even, even, {}});
  if (change.expression) change.low = change.high = evaluate(*change.expression, factors);
  return StimulusEnd{*whole - change.high, *whole - change.low};
}

}  // namespace

std::optional<StimulusEnd> stimulus_end(const Protocol& protocol) {
  const auto last = last_parts(protocol.task);
  std::vector<const Linear*> times;
  for (const auto& part : last)
    if (const auto* length = length_of(protocol.task, part)) times.push_back(length);
  if (const auto& foreperiod = protocol.task.foreperiod_s; foreperiod && foreperiod->expression)
    times.push_back(&*foreperiod->expression);
  std::optional<StimulusEnd> all;
  for (const auto& corner : corners(times, protocol.factors)) {
    const auto end = stimulus_end(protocol, corner);
    if (!end) return std::nullopt;
    all = joined(all.value_or(*end), *end);
  }
  return all;
}

std::optional<StimulusEnd> stimulus_end(const Protocol& protocol, const Factors& factors) {
  if (protocol.timing.response_zero == ResponseZero::interval_off) return StimulusEnd{};
  std::optional<StimulusEnd> all;
  for (const auto& part : last_parts(protocol.task)) {
    const auto end = end_of(protocol, part, factors);
    if (!end) return std::nullopt;
    all = joined(all.value_or(*end), *end);
  }
  return all;
}

std::optional<LatestChange> latest_change(const Protocol& protocol) {
  const auto& task = protocol.task;
  if (!task.foreperiod_s) return std::nullopt;
  const auto& foreperiod = task.foreperiod_s->expression;
  std::optional<LatestChange> latest;
  for (const auto& part : parts_of(task)) {
    const auto* length = length_of(task, part);
    if (part.scenes.size() < 2 || (length == nullptr && !protocol.timing.explore_s)) continue;
    std::vector<const Linear*> times;
    if (length != nullptr) times.push_back(length);
    if (foreperiod) times.push_back(&*foreperiod);
    for (const auto& corner : corners(times, protocol.factors)) {
      const LatestChange here{foreperiod ? evaluate(*foreperiod, corner) : task.foreperiod_s->high,
                              length ? evaluate(*length, corner) : *protocol.timing.explore_s};
      if (!latest || here.change_s - here.whole_s > latest->change_s - latest->whole_s) latest = here;
    }
  }
  return latest;
}

double quick_trial_s(const Protocol& protocol, double answer_s) {
  const auto mean = [](const Distribution& times_s) { return 0.5 * (times_s.low + times_s.high); };
  const auto middle = [&](const Linear& expression) {
    const auto [low, high] = bounds(expression, protocol.factors);
    return 0.5 * (low + high);
  };
  const auto& task = protocol.task;
  const auto intervals =
      task.intervals.empty() ? std::vector<std::vector<std::string>>{{task.standard}} : task.intervals;
  double stimuli_s = 0;
  for (const auto& parts : parts_of_trial(task, intervals))
    for (const auto& part : parts) {
      for (const auto& silence : part.silences_s) stimuli_s += middle(silence);
      if (const auto* length = length_of(task, part))
        stimuli_s += middle(*length);
      else if (task.foreperiod_s)
        stimuli_s += mean(*task.foreperiod_s);
    }
  if (task.gap_s) stimuli_s += static_cast<double>(intervals.size() - 1) * middle(*task.gap_s);
  return middle(task.cue_s) + stimuli_s + answer_s + mean(protocol.timing.iti_s);
}

std::optional<double> accepted(const ValueAnswer& answer, double given) {
  const double scale = std::pow(10.0, answer.decimals);
  const double value = std::round(given * scale) / scale;
  if (!(value >= answer.low && value <= answer.high)) return std::nullopt;
  if (answer.typed && std::fabs(given - value) > 1e-6 / scale) return std::nullopt;
  return value;
}

double middle_level(const Protocol& protocol, const std::string& level) {
  const auto rule = answer_rule(protocol, level);
  const bool sides = rule.kind == AnswerKind::side, decibel = !sides && level.ends_with("_dB");
  const auto distance = [&](double value) {
    return std::fabs((rule.size ? std::fabs(value) : value) - rule.cut);
  };
  std::vector<double> by_procedures, by_blocks;
  for (const auto& source : sources_of(protocol)) {
    if (source.level != level) continue;
    for (const double value : levels_of(source))
      if (decibel || distance(value) != 0)
        (source.spec ? by_procedures : by_blocks).push_back(decibel ? value : distance(value));
  }
  auto& all = by_procedures.empty() ? by_blocks : by_procedures;
  if (all.empty()) return 1;
  return core::median(all);
}

double middle_level_of(const Protocol& protocol, const std::string& level) {
  for (const auto& meaning : protocol.meanings)
    if (meaning.level == level) return meaning.middle;
  return middle_level(protocol, level);
}

}  // namespace turnpoint::protocol

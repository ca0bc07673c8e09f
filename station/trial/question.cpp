#include "station/trial/question.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "station/core/number.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/resolve.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::trial {

using core::phrase, core::plain;

namespace {

/// Returns the name of the factor that the trial's level sets: the factor of the trial's procedure or, if the
/// trial has no procedure, the level factor of the first trials in the protocol that have one.
std::string level_factor(const TrialSpec& spec, const protocol::Protocol& protocol) {
  if (const auto* procedure = protocol::find_procedure(protocol, spec.procedure)) return procedure->level;
  if (!protocol.procedures.empty()) return protocol.procedures.front().level;
  const auto sources = protocol::sources_of(protocol);
  return sources.empty() ? "" : sources.front().level;
}

/// Sets the trial's value of the second dimension of its procedure. Trials without a procedure (practice,
/// catch trials) take it from the first procedure that has the same level.
void set_second(const TrialSpec& spec, const protocol::Protocol& protocol, const std::string& level,
                simulation::Question& question) {
  const auto* procedure = protocol::find_procedure(protocol, spec.procedure);
  for (const auto& other : protocol.procedures)
    if (!procedure && other.level == level && other.second) procedure = &other;
  if (!procedure || !procedure->second) return;
  const auto found = spec.factors.find(procedure->second->level);
  const auto* value = found == spec.factors.end() ? nullptr : std::get_if<double>(&found->second);
  if (value) question.second = *value - procedure->second->origin;
  constexpr double ln10 = 2.302585092994046;
  if (procedure->scale != procedure::Scale::linear)
    question.log_step = procedure->scale == procedure::Scale::dB ? ln10 / 20 : ln10;
}

simulation::Finding finding_of(protocol::TaskKind kind) {
  switch (kind) {
    case protocol::TaskKind::several_intervals:
      return simulation::Finding::largest;
    case protocol::TaskKind::abx:
    case protocol::TaskKind::match_to_sample:
      return simulation::Finding::nearest;
    default:
      return simulation::Finding::weibull;
  }
}

/// Returns the median distance between neighbouring categories.
double median_step(std::vector<double> categories) {
  std::sort(categories.begin(), categories.end());
  for (std::size_t i = 0; i + 1 < categories.size(); ++i) categories[i] = categories[i + 1] - categories[i];
  categories.pop_back();
  std::sort(categories.begin(), categories.end());
  return categories[categories.size() / 2];
}

/// The stimuli of the intervals of a comparison: the values of the factors on which their scenes depend.
std::vector<double> stimuli_of(const TrialSpec& spec, const protocol::Protocol& protocol,
                               const procedure::Spec& procedure) {
  std::vector<double> stimuli;
  for (const auto& scenes : spec.intervals) {
    const auto found = spec.factors.find(protocol::presented(protocol, procedure, scenes));
    const auto* value = found == spec.factors.end() ? nullptr : std::get_if<double>(&found->second);
    if (!value) return {};
    stimuli.push_back(*value);
  }
  return stimuli;
}

/// Turns a comparison into the question on which side of 0 a difference lies: that of the two stimuli, or of
/// the sizes of two differences.
simulation::Question compared(const TrialSpec& spec, const protocol::Protocol& protocol,
                              simulation::Question question) {
  const auto* procedure = protocol::find_procedure(protocol, spec.procedure);
  if (!procedure && !protocol.procedures.empty()) procedure = &protocol.procedures.front();
  const auto at = procedure ? stimuli_of(spec, protocol, *procedure) : std::vector<double>{};
  question.decides = simulation::Decides::side, question.decibel = false, question.positive = 1;
  if (at.empty()) return question;
  const auto last = at.size() - 1;
  question.level = last == 1 ? at[1] - at[0] : std::fabs(at[last] - at[last - 1]) - std::fabs(at[1] - at[0]);
  const auto& values = procedure->values;
  question.default_threshold = median_step(values);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  question.range = *high - *low;
  for (const double stimulus : at) question.compared.push_back((stimulus - *low) / question.range);
  return question;
}

}  // namespace

simulation::Question question_of(const TrialSpec& spec, const protocol::Protocol& whole, std::uint64_t seed) {
  const auto& protocol = protocol::of_task(whole, spec.task);
  simulation::Question question;
  question.level = spec.level.value_or(0);
  question.correct = spec.correct;
  question.deadline_s = spec.deadline_s;
  question.signal_s = spec.signal_s;
  question.answers = static_cast<int>(protocol.task.choices.size());
  question.key = {seed, core::Stream::observer, spec.block_index, spec.attempt, spec.trial_in_block};
  const auto level = level_factor(spec, protocol);
  question.decibel = level.ends_with("_dB");
  question.default_threshold = protocol::middle_level_of(protocol, level);
  set_second(spec, protocol, level, question);
  const auto& task = protocol.task;
  question.unsure = !task.unsure.empty();
  question.again = task.again;
  if (task.confidence) question.confidence = static_cast<int>(task.confidence->labels.size());
  if (protocol::judges(task)) {
    question.decides = simulation::Decides::presence;
    question.rating = task.rating;
    question.middle = !question.decibel && protocol::two_sided(protocol, level)
                          ? simulation::Middle::bias
                          : simulation::Middle::threshold;
    if (task.present) {
      question.middle = simulation::Middle::criterion;
      question.absent = !protocol::holds(*task.present, spec.factors);
    }
    if (const auto& value = task.value)
      question.value = {value->typed, value->low, value->high, value->decimals,
                        task.modulus.value_or(std::sqrt(std::max(value->low, 1e-3) * value->high))};
    return question;
  }
  if (task.kind == protocol::TaskKind::comparison) return compared(spec, protocol, question);
  const auto rule = protocol::answer_rule_of(protocol, level);
  question.positive = rule.positive, question.cut = rule.cut;
  // in 2ifc the answer is the interval that holds the scene
  if (task.kind == protocol::TaskKind::two_interval && rule.kind == protocol::AnswerKind::side)
    for (std::size_t i = 0; i < spec.intervals.size() && i < 2; ++i) {
      const auto scene = protocol::scene_of(task, rule.positive);
      const auto& interval = spec.intervals[i];
      if (std::find(interval.begin(), interval.end(), scene) != interval.end())
        question.positive = static_cast<int>(i);
    }
  if (rule.size) question.level = std::fabs(question.level);
  switch (rule.kind) {
    case protocol::AnswerKind::right_answer:
      question.finding = finding_of(task.kind);
      break;
    case protocol::AnswerKind::category:
      question.decides = simulation::Decides::category;
      question.categories = rule.categories;
      question.default_threshold = median_step(rule.categories);
      break;
    case protocol::AnswerKind::side:
      question.decides = simulation::Decides::side;
      break;
    case protocol::AnswerKind::presence:
      question.decides = simulation::Decides::presence;
      question.absent = protocol.task.kind == protocol::TaskKind::same_different && spec.correct &&
                        *spec.correct != rule.positive;
      break;
  }
  return question;
}

double equal_setting(const protocol::Protocol& protocol, const protocol::Factors& factors) {
  const auto& task = protocol.task;
  const auto factor = std::find_if(protocol.factors.begin(), protocol.factors.end(),
                                   [&](const auto& entry) { return entry.name == task.adjusts; });
  const auto [low, high] = factor->range.value();
  const auto parts = protocol::parts_of(task, task.intervals.back());
  const auto &first = parts.front().scenes.front(), &last = parts.back().scenes.back();
  if (parts.size() > 1 || parts.front().scenes.size() > 1)
    if (const auto equal = protocol::where_equal(protocol, first, last, task.adjusts, low, high, factors))
      return *equal;
  return low <= 0 && high >= 0 ? 0 : 0.5 * (low + high);
}

simulation::Adjustment adjustment_of(const TrialSpec& spec, const protocol::Protocol& whole,
                                     std::uint64_t seed) {
  const auto& protocol = protocol::of_task(whole, spec.task);
  simulation::Adjustment adjustment;
  adjustment.start = spec.level.value_or(spec.slider->low);
  adjustment.low = spec.slider->low, adjustment.high = spec.slider->high;
  adjustment.equal = equal_setting(protocol, spec.factors);
  // after the tones there is nothing to feel, and after the deadline nothing counts
  const auto last = parts_of(whole, spec).back();
  const auto times = simulated_times(whole, spec, last, 0);
  const auto from_slider_s = [&times](std::int64_t from_onset_ns) {
    return 1e-9 * static_cast<double>(from_onset_ns - times.slider_ns);
  };
  constexpr double least_s = 0.05;  // where there is no time at all, the setting comes too late anyway
  adjustment.within_s = std::max(
      least_s, std::min(last.length_s + from_slider_s(0), spec.deadline_s + from_slider_s(times.zero_ns)));
  adjustment.again = protocol.task.again;
  adjustment.key = {seed, core::Stream::observer, spec.block_index, spec.attempt, spec.trial_in_block};
  return adjustment;
}

namespace {

/// The deadlines of the protocol's blocks, each once.
std::vector<const protocol::Linear*> deadlines_of(const protocol::Protocol& protocol) {
  std::vector<const protocol::Linear*> deadlines;
  for (const auto& block : protocol::all_blocks(protocol)) {
    const auto* deadline = protocol::deadline_of_instruction(protocol, block);
    if (deadline == nullptr && protocol.timing.deadline_s) deadline = &*protocol.timing.deadline_s;
    const bool known = std::find(deadlines.begin(), deadlines.end(), deadline) != deadlines.end();
    if (deadline != nullptr && !known && block.kind == protocol::BlockKind::trials)
      deadlines.push_back(deadline);
  }
  return deadlines;
}

/// How long after response zero a simulated observer's answers are taken at the earliest and at the latest.
std::pair<double, double> answers_from_s(const protocol::Protocol& protocol) {
  if (protocol::explored(protocol.task)) return {0, 0};
  if (const auto end = protocol::stimulus_end(protocol)) return {end->earliest_s, end->latest_s};
  if (protocol.timing.response_zero != ResponseZero::first_contact) return {0, 0};
  const auto parts = protocol::parts_of(protocol.task);
  if (parts.empty()) return {0, 0};
  const auto [low_s, high_s] = protocol::length_range_s(protocol, parts.back());
  return {low_s - reach_s(low_s), high_s - reach_s(high_s)};
}

}  // namespace

std::vector<core::Problem> observer_notes(const protocol::Protocol& protocol,
                                          const simulation::Observer& observer) {
  std::vector<core::Problem> notes;
  for (const auto& one : protocol.by_task)
    for (auto& note : observer_notes(one, observer)) protocol::add_once(std::move(note), notes);
  if (!protocol.by_task.empty()) return notes;
  if (protocol.task.kind == protocol::TaskKind::adjustment || protocol.timing.signal) return notes;
  const auto [least_s, most_s] = observer.nondecision_range_s();
  const auto seconds = [](double s) { return plain(core::number(s, 3)); };
  const auto [first_open_s, opens_s] = answers_from_s(protocol);
  for (const auto* deadline : deadlines_of(protocol)) {
    const double shortest_s = protocol::bounds(*deadline, protocol.factors).first;
    const double left_s = shortest_s - most_s;
    if (shortest_s < opens_s) {
      notes.push_back(
          {deadline->place,
           phrase("the simulated observer can answer only when the last interval has ended, up to "
                  "%1 s after \"%2\", so a deadline of %3 s is over before",
                  {seconds(opens_s), plain(name(protocol.timing.response_zero)), seconds(shortest_s)}),
           phrase("a longer deadline, or %1", {plain("response_zero = \"interval_off\"")})});
      continue;
    }
    if (left_s > kLeastDecision_s - 1e-9) continue;
    notes.push_back(
        {deadline->place,
         left_s > 0
             ? phrase("the simulated observer needs %1 s outside its decision (its residual and travel), so "
                      "a deadline of %2 s leaves it only %3 s to decide, and it guesses; people may be "
                      "quicker",
                      {seconds(most_s), seconds(shortest_s), seconds(left_s)})
             : phrase("the simulated observer needs %1 s outside its decision (its residual and travel), so "
                      "a deadline of %2 s leaves it no time to decide, and its answers are guesses that "
                      "come too late; people may be quicker",
                      {seconds(most_s), seconds(shortest_s)}),
         phrase("--observer sim:residual=...,travel=... of `run` and `power` simulates quicker people")});
  }
  const auto& early = protocol.timing.anticipation_s;
  if (const double early_s = protocol::bounds(early, protocol.factors).second;
      early_s > std::max(least_s, first_open_s))
    notes.push_back(
        {early.place,
         phrase("the simulated observer may answer after %1 s (its residual and travel), and answers before "
                "%2 s "
                "count as too early; people may be slower",
                {seconds(least_s), seconds(early_s)}),
         phrase("--observer sim:residual=...,travel=... of `run` and `power` simulates slower people")});
  return notes;
}

}  // namespace turnpoint::trial

#include "station/trial/question.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "station/protocol/answers.hpp"
#include "station/protocol/resolve.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::trial {

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

}  // namespace

simulation::Question question_of(const TrialSpec& spec, const protocol::Protocol& protocol,
                                 std::uint64_t seed) {
  simulation::Question question;
  question.level = spec.level.value_or(0);
  question.correct = spec.correct;
  question.deadline_s = spec.deadline_s;
  question.signal_s = spec.signal_s;
  question.answers = static_cast<int>(protocol.task.choices.size());
  question.key = {seed, core::Stream::observer, spec.block_index, spec.attempt, spec.trial_in_block};
  const auto level = level_factor(spec, protocol);
  question.decibel = level.ends_with("_dB");
  question.default_threshold = protocol::middle_level(protocol, level);
  set_second(spec, protocol, level, question);
  const auto& task = protocol.task;
  question.unsure = !task.unsure.empty();
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
  if (const auto& scenes = task.intervals.back(); scenes.size() > 1)
    if (const auto equal =
            protocol::where_equal(protocol, scenes.front(), scenes.back(), task.adjusts, low, high, factors))
      return *equal;
  return low <= 0 && high >= 0 ? 0 : 0.5 * (low + high);
}

simulation::Adjustment adjustment_of(const TrialSpec& spec, const protocol::Protocol& protocol,
                                     std::uint64_t seed) {
  simulation::Adjustment adjustment;
  adjustment.start = spec.level.value_or(spec.slider->low);
  adjustment.low = spec.slider->low, adjustment.high = spec.slider->high;
  adjustment.equal = equal_setting(protocol, spec.factors);
  adjustment.key = {seed, core::Stream::observer, spec.block_index, spec.attempt, spec.trial_in_block};
  return adjustment;
}

}  // namespace turnpoint::trial

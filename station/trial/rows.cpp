#include "station/trial/rows.hpp"

#include "station/core/number.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/tasks.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::trial {

namespace {

std::optional<double> seconds(const std::optional<std::int64_t>& ns) {
  return ns ? std::optional(static_cast<double>(*ns) * 1e-9) : std::nullopt;
}

/// Returns the "response" to store for a trial without a question: a word for how the finger moved.
/// Simulations without a surface know only whether the movement was right or wrong.
std::string movement_word(const core::TrialRow& row, int response) {
  if (!row.finger.sensing.empty()) return row.finger.sensing;
  return response == 0 ? "ok" : "strokes";
}

}  // namespace

core::BlockStart block_start(const protocol::Block& block, int block_index, int attempt) {
  core::BlockStart start;
  start.block_index = block_index;
  start.attempt = attempt;
  start.name = block.name;
  start.practice = block.practice;
  const auto found = block.fixed.find("instruction");
  if (found != block.fixed.end())
    if (const auto* text = std::get_if<std::string>(&found->second)) start.instruction = *text;
  return start;
}

core::TrialRow row_of(const TrialSpec& spec, const protocol::Protocol& protocol, int trial_index) {
  core::TrialRow row;
  row.trial_index = trial_index;
  row.trial_in_block = spec.trial_in_block;
  row.type = spec.type;
  row.procedure = spec.procedure;
  row.level = spec.level;
  for (const auto& [name, value] : spec.factors)
    std::visit([&row, &name = name](const auto& v) { row.factors[name] = v; }, value);
  if (spec.correct)
    row.correct_response =
        spec.strokes ? "ok" : protocol::answer_id(protocol::of_task(protocol, spec.task).task, *spec.correct);
  row.timing.response_zero = name(zero_of(protocol, spec));
  row.timing.response_time_quality = "n/a";
  row.timing.deadline_s = spec.deadline_s;
  return row;
}

void fill_result(core::TrialRow& row, const Result& result, const TrialSpec& spec,
                 const protocol::Protocol& protocol, std::int64_t origin_ns,
                 const std::optional<double>& value) {
  auto& given = row.given;
  auto& timing = row.timing;
  row.outcome = result.outcome;
  if (result.response)
    given.response = value
                         ? core::exact(*value)
                         : protocol::answer_id(protocol::of_task(protocol, spec.task).task, *result.response);
  if (result.response && spec.strokes) given.response = movement_word(row, *result.response);
  given.correct = result.correct;
  given.confidence = result.confidence;
  given.confidence_time_s = seconds(result.confidence_time_ns);
  timing.onset_ns = result.zero_ns.value_or(result.started_ns);
  timing.onset_s = static_cast<double>(timing.onset_ns - origin_ns) * 1e-9;
  timing.duration_s = static_cast<double>(result.ended_ns - result.started_ns) * 1e-9;
  timing.response_time_s = seconds(result.response_time_ns);
  timing.decision_time_s = seconds(result.decision_time_ns);
  timing.movement_time_s = seconds(result.movement_time_ns);
  given.extra_touches = result.extra_touches;
  if (protocol::of_task(protocol, spec.task).task.again > 0 && !spec.strokes) given.again = result.again;
  row.presented.xruns = result.xruns;
  if (!spec.correct) given.correct.reset();
  given.points = points_of(result, spec, protocol);
  if (!result.response) timing.response_time_quality = "n/a";
}

std::optional<double> points_of(const Result& result, const TrialSpec& spec,
                                const protocol::Protocol& protocol) {
  if (!protocol.payoff || spec.strokes || spec.type == core::TrialType::warmup) return std::nullopt;
  const auto& payoff = *protocol.payoff;
  const auto value = [&](const protocol::Linear& points) { return protocol::evaluate(points, spec.factors); };
  switch (result.outcome) {
    case Outcome::answered:
      break;
    case Outcome::timeout:
      return value(payoff.late);
    case Outcome::anticipation:
      return value(payoff.early);
    case Outcome::aborted:
    case Outcome::fault:
      return std::nullopt;
  }
  if (!spec.correct) return std::nullopt;
  if (!result.correct)  // the participant did not want to guess
    return value(payoff.unsure);
  if (!*result.correct) return value(payoff.wrong);
  const auto time_s = seconds(result.response_time_ns);
  const bool fast = payoff.fast && time_s && *time_s < value(payoff.fast->below_s);
  return value(payoff.right) + (fast ? value(payoff.fast->points) : 0);
}

}  // namespace turnpoint::trial

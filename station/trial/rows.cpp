#include "station/trial/rows.hpp"

#include "station/core/number.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::trial {

namespace {

std::optional<double> seconds(const std::optional<std::int64_t>& ns) {
  return ns ? std::optional(static_cast<double>(*ns) * 1e-9) : std::nullopt;
}

std::string choice_id(const protocol::Protocol& protocol, int index) {
  const auto& choices = protocol.task.choices;
  return index >= 0 && index < static_cast<int>(choices.size()) ? choices[static_cast<std::size_t>(index)].id
                                                                : "";
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
  if (spec.correct) row.correct_response = spec.strokes ? "ok" : choice_id(protocol, *spec.correct);
  row.response_zero = name(zero_of(protocol, spec));
  row.response_time_quality = "n/a";
  row.deadline_s = spec.deadline_s;
  return row;
}

void fill_result(core::TrialRow& row, const Result& result, const TrialSpec& spec,
                 const protocol::Protocol& protocol, std::int64_t origin_ns,
                 const std::optional<double>& value) {
  row.outcome = result.outcome;
  if (result.response) row.response = value ? core::exact(*value) : choice_id(protocol, *result.response);
  if (result.response && spec.strokes) row.response = movement_word(row, *result.response);
  row.correct = result.correct;
  row.confidence = result.confidence;
  row.confidence_time_s = seconds(result.confidence_time_ns);
  row.onset_ns = result.zero_ns.value_or(result.started_ns);
  row.onset_s = static_cast<double>(row.onset_ns - origin_ns) * 1e-9;
  row.duration_s = static_cast<double>(result.ended_ns - result.started_ns) * 1e-9;
  row.response_time_s = seconds(result.response_time_ns);
  row.decision_time_s = seconds(result.decision_time_ns);
  row.movement_time_s = seconds(result.movement_time_ns);
  row.extra_touches = result.extra_touches;
  row.xruns = result.xruns;
  if (!spec.correct) row.correct.reset();
  if (!result.response) row.response_time_quality = "n/a";
}

}  // namespace turnpoint::trial

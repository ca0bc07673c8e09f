#include "station/session/program_estimator.hpp"

#include <algorithm>

#include "station/session/conversation.hpp"

namespace turnpoint::session {

namespace {

template <class T>
Json json_of(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json message_of(const core::BlockStart& block, const core::TrialRow& row) {
  auto factors = Json::object();
  for (const auto& [name, value] : row.factors)
    std::visit([&, &key = name](const auto& v) { factors[key] = v; }, value);
  return {{"type", "trial"},
          {"trial", row.trial_index},
          {"block", block.name},
          {"instruction", block.instruction},
          {"procedure", row.procedure},
          {"level", json_of(row.level)},
          {"factors", factors},
          {"outcome", core::name(row.outcome)},
          {"response", json_of(row.given.response)},
          {"correct", json_of(row.given.correct)},
          {"response_time_s", json_of(row.timing.response_time_s)},
          {"confidence", json_of(row.given.confidence)}};
}

/// True if a later attempt at the same block has begun.
bool repeated(const core::BlockRecord& block, const std::vector<core::BlockRecord>& blocks) {
  return std::ranges::any_of(blocks, [&](const auto& other) {
    return other.start.block_index == block.start.block_index && other.start.attempt > block.start.attempt;
  });
}

}  // namespace

std::map<std::string, procedure::Estimate> estimates_in(const Json& message, const Conversation& from) {
  const auto& all = message.at("estimates");
  if (!all.is_object()) from.fail("\"estimates\" must be an object");
  std::map<std::string, procedure::Estimate> estimates;
  for (const auto& [parameter, values] : all.items()) {
    if (parameter.empty() || !values.is_object())
      from.fail("each of \"estimates\" must be an object with a name");
    procedure::Estimate estimate;
    estimate.mode = estimate.mean = number_in(values, "mean", from);
    if (values.contains("sd") && !values["sd"].is_null()) {
      estimate.sd = number_in(values, "sd", from);
      if (*estimate.sd < 0) from.fail("\"sd\" must not be negative");
    }
    if (values.contains("basis") && !values["basis"].is_null())
      estimate.basis = text_in(values, "basis", from);
    estimates[parameter] = estimate;
  }
  return estimates;
}

Estimated estimated_by(const std::string& estimator, const protocol::Protocol& protocol,
                       const std::vector<core::BlockRecord>& blocks) {
  const auto choice = existing_program("--estimator", estimator);
  auto choices = Json::array();
  for (const auto& answer : protocol.task.choices) choices.push_back(answer.id);
  Conversation with(choice.path, choice.limit_s,
                    {{"role", "estimator"},
                     {"protocol", protocol.id},
                     {"level", protocol::common_level(protocol).value_or("")},
                     {"choices", choices},
                     {"settings", choice.settings}});
  for (const auto& block : blocks) {
    if (block.start.practice || repeated(block, blocks)) continue;
    for (const auto& row : block.trials)
      if (row.type == core::TrialType::experimental && row.outcome != core::Outcome::fault &&
          row.outcome != core::Outcome::aborted)
        with.tell(message_of(block.start, row));
  }
  with.ask({{"type", "estimate"}});
  const auto reply = with.wait_for_reply();
  if (reply["type"] != "estimates" || !reply.contains("estimates"))
    with.fail("did not reply to \"estimate\" with \"estimates\"");
  return {with.identity().value(), estimates_in(reply, with)};
}

}  // namespace turnpoint::session

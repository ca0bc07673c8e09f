#include "station/trial/earlier_trials.hpp"

#include <algorithm>
#include <variant>

#include "station/protocol/answers.hpp"
#include "station/protocol/sources.hpp"

namespace turnpoint::trial {

namespace {

bool was_repeated(const core::BlockRecord& block, const std::vector<core::BlockRecord>& blocks) {
  return std::ranges::any_of(blocks, [&](const auto& other) {
    return other.start.block_index == block.start.block_index && other.start.attempt > block.start.attempt;
  });
}

procedure::Answer answer_in(const core::TrialRow& row, const procedure::Spec& spec) {
  if (row.outcome != core::Outcome::answered) return procedure::Answer::none;
  return protocol::learned_from(spec, row.given.response.value_or(""), row.given.correct);
}

}  // namespace

void add_earlier_trials(const protocol::Protocol& protocol, const std::vector<core::BlockRecord>& blocks,
                        procedure::EarlierTrials& earlier) {
  for (const auto& block : blocks) {
    if (block.start.practice || was_repeated(block, blocks)) continue;
    for (const auto& row : block.trials) {
      const auto* spec = protocol::find_procedure(protocol, row.procedure);
      if (spec == nullptr || !spec->continues || row.type != core::TrialType::experimental ||
          row.outcome == core::Outcome::fault || row.outcome == core::Outcome::aborted)
        continue;
      procedure::EarlierTrial trial{row.level.value(), answer_in(row, *spec)};
      if (spec->second) trial.second = std::get<double>(row.factors.at(spec->second->level));
      earlier[row.procedure].push_back(trial);
    }
  }
}

}  // namespace turnpoint::trial

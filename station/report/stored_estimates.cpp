#include "station/report/stored_estimates.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "station/procedure/continuation.hpp"
#include "station/procedure/description.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"
#include "station/report/stored_trials.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

/// Returns the place of a procedure among those of its block, which is part of the key of its draws.
std::size_t place_in_block(const procedure::Spec& spec, const std::string& block,
                           const protocol::Protocol& protocol) {
  for (const auto& part : protocol.plan) {
    const auto& names = protocol::block_of(part).procedures;
    if (protocol::block_of(part).name == block)
      return static_cast<std::size_t>(std::find(names.begin(), names.end(), spec.name) - names.begin());
  }
  return 0;
}

/// An answer that a procedure has learned from.
struct Learned {
  const core::TrialRow* row;
  bool one;
};

/// Gives the procedure the answers of its trials in a block. Returns those from which it has learned; nothing
/// if a procedure that continues would have presented other levels, because its earlier sessions are not
/// known.
std::optional<std::vector<Learned>> replay(const std::vector<core::TrialRow>& trials,
                                           const procedure::Spec& spec, procedure::Procedure& replayed) {
  std::vector<Learned> learned;
  for (const auto& row : trials) {
    if (row.procedure != spec.name || row.type != core::TrialType::experimental ||
        row.outcome == core::Outcome::fault || row.outcome == core::Outcome::aborted || !replayed.next())
      continue;
    if (spec.continues && replayed.next()->level != row.level) return std::nullopt;
    if (row.outcome != core::Outcome::answered) {
      replayed.record(procedure::Answer::none);
      continue;
    }
    const auto answer = protocol::learned_from(spec, row.given.response.value_or(""), row.given.correct);
    replayed.record(answer);
    learned.push_back({&row, answer == procedure::Answer::one});
  }
  return learned;
}

std::optional<analysis::Interval> interval_of(const procedure::Estimate& estimate) {
  if (!estimate.interval) return std::nullopt;
  return analysis::Interval{estimate.interval->first, estimate.interval->second, 0.95};
}

void add_curve(const std::string& block, const procedure::Spec& spec, const procedure::Procedure& replayed,
               const std::vector<Learned>& learned, SessionData& data) {
  if (!spec.second) return;
  const auto second = protocol::words_of(spec.second->level);
  ThresholdCurve curve;
  curve.block = block, curve.procedure = spec.name, curve.label = axis_label(second.name, second.unit);
  curve.ratios = spec.scale != procedure::Scale::linear;
  for (const auto& [at, estimate] : replayed.thresholds())
    curve.points.push_back({at, estimate.mean, *interval_of(estimate)});
  for (const auto& [row, one] : learned)
    for (const auto& [name, value] : row->factors)
      if (const auto* at = std::get_if<double>(&value); at && name == spec.second->level)
        curve.trials.push_back({*at, row->level.value_or(0), one});
  data.threshold_curves.push_back(std::move(curve));
}

/// Unit of a parameter that a separate program estimated: that of the level for thresholds.
std::string unit_of_program(const std::string& parameter, const std::string& level) {
  if (level.empty() || (!parameter.starts_with("threshold") && parameter != "pse")) return "";
  return protocol::words_of(level).unit;
}

}  // namespace

void add_estimates(const std::vector<core::BlockRecord>& blocks, const protocol::Protocol& protocol,
                   std::uint64_t seed, const procedure::EarlierTrials& earlier, SessionData& data) {
  const auto counted = last_attempts(blocks);
  for (const auto& spec : protocol.procedures) {
    if (!procedure::follows_answers(spec) || spec.kind == procedure::Kind::program) continue;
    const auto& kind = procedure::description(spec.kind);
    const bool posterior = kind.choice == procedure::Choice::posterior;
    const auto& task = protocol::of_task(protocol, protocol::task_of(protocol, spec.name, "")).task;
    const auto choices = std::max<std::size_t>(2, task.choices.size());
    const double least = spec.tracks.empty() ? 1.0 / static_cast<double>(choices) : 0;
    for (const auto* block : counted) {
      if (block->start.practice) continue;
      const auto key =
          procedure::key_of(seed, block->start.block_index, place_in_block(spec, block->start.name, protocol),
                            block->start.attempt);
      const auto replayed = procedure::make_procedure(spec, {}, key);
      if (const auto before = earlier.find(spec.name); spec.continues && before != earlier.end())
        procedure::continue_from(before->second, spec, *replayed);
      const auto learned = replay(block->trials, spec, *replayed);
      if (!learned) continue;
      if (const auto end = replayed->end()) data.early_ends.push_back({block->start.name, spec.name, *end});
      if (replayed->recorded() == 0) continue;
      for (const auto& [parameter, estimate] : replayed->estimates())
        data.estimates.push_back({block->start.name, spec.name, parameter, estimate.mean, estimate.sd,
                                  posterior ? "mean of its posterior" : estimate.basis,
                                  unit_of(parameter, spec), interval_of(estimate), kind.choice,
                                  kind.settles_at(spec, least, 1)});
      add_curve(block->start.name, spec, *replayed, *learned, data);
    }
  }
}

void add_program_estimates(const std::vector<core::BlockRecord>& blocks,
                           const std::vector<core::EventRow>& events, const protocol::Protocol& protocol,
                           SessionData& data) {
  // The newest event about a block counts: an interrupted session may have ended the block twice.
  std::map<std::tuple<int, std::string, std::string>, std::pair<int, core::EstimateRow>> newest;
  for (const auto& event : events)
    for (const auto& row : event.estimates)
      newest.insert_or_assign({row.block_index, row.procedure, row.parameter}, std::pair(row.attempt, row));
  for (const auto& [key, found] : newest)
    for (const auto& block : blocks) {
      if (block.start.block_index != std::get<0>(key) || block.start.attempt != found.first ||
          block.start.practice)
        continue;
      const auto& row = found.second;
      const auto* spec = protocol::find_procedure(protocol, row.procedure);
      data.estimates.push_back({block.start.name,
                                row.procedure,
                                row.parameter,
                                row.mean,
                                row.sd,
                                row.basis,
                                unit_of_program(row.parameter, spec ? spec->level : ""),
                                std::nullopt,
                                procedure::Choice::program,
                                {}});
    }
}

void add_estimator(const std::string& program, const std::map<std::string, procedure::Estimate>& estimates,
                   const protocol::Protocol& protocol, SessionData& data) {
  for (const auto& [parameter, estimate] : estimates)
    data.estimates.push_back({"all blocks",
                              program,
                              parameter,
                              estimate.mean,
                              estimate.sd,
                              estimate.basis,
                              unit_of_program(parameter, protocol::common_level(protocol).value_or("")),
                              std::nullopt,
                              procedure::Choice::program,
                              {}});
}

core::Phrase axis_label(std::string name, const std::string& unit) {
  if (name[0] >= 'a' && name[0] <= 'z') name[0] = static_cast<char>(name[0] - 'a' + 'A');
  return in_unit(core::plain(std::move(name)), core::plain(unit));
}

std::string unit_of(const std::string& parameter, const procedure::Spec& spec) {
  const auto level = protocol::words_of(spec.level).unit;
  if (parameter == "criterion") return "SD of noise";
  if (parameter == "gradient" && spec.second) {
    const auto second = protocol::words_of(spec.second->level).unit;
    const auto rise = spec.scale == procedure::Scale::dB      ? "dB"
                      : spec.scale == procedure::Scale::log10 ? "decades"
                                                              : level;
    if (second.empty()) return rise;
    return (rise.empty() ? "1" : rise) + "/" + second;
  }
  return parameter.starts_with("threshold") || parameter == "pse" || parameter == "floor" ? level : "";
}

void keep_estimates_of(const protocol::Protocol& protocol, SessionData& data) {
  const auto other = [&](const auto& of) { return !protocol::find_procedure(protocol, of.procedure); };
  if (protocol.task.name.empty()) return;
  std::erase_if(data.estimates, other);
  std::erase_if(data.early_ends, other);
  std::erase_if(data.threshold_curves, other);
}

}  // namespace turnpoint::report

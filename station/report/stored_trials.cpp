#include "station/report/stored_trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "station/analysis/psychometric_posterior.hpp"
#include "station/procedure/description.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/sources.hpp"
#include "station/report/stored_estimates.hpp"
#include "station/text/number.hpp"

namespace turnpoint::report {

namespace {

std::optional<int> index_of(const std::optional<std::string>& id, const protocol::Protocol& protocol) {
  if (!id) return std::nullopt;
  const auto& choices = protocol.task.choices;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].id == *id) return static_cast<int>(i);
  return std::nullopt;
}

protocol::Factors factors_of(const records::TrialRow& row) {
  protocol::Factors factors;
  for (const auto& [name, value] : row.factors)
    std::visit([&factors, &key = name](const auto& v) { factors[key] = v; }, value);
  return factors;
}

/// Returns the side from which a slider started.
analysis::StartSide side_of(const records::TrialRow& row, const protocol::Protocol& protocol) {
  const auto* spec = protocol::find_procedure(protocol, row.procedure);
  if (!spec || spec->kind != procedure::Kind::adjustment || !row.level) return analysis::StartSide::none;
  const auto has = [&](const std::vector<double>& starts) {
    return std::find(starts.begin(), starts.end(), *row.level) != starts.end();
  };
  return has(spec->ascending.values)    ? analysis::StartSide::below
         : has(spec->descending.values) ? analysis::StartSide::above
                                        : analysis::StartSide::none;
}

analysis::TrialRecord record_of(const records::TrialRow& row, const records::BlockStart& block,
                                const protocol::Protocol& protocol) {
  analysis::TrialRecord record;
  record.trial_index = row.trial_index;
  record.block_index = block.block_index;
  record.block = block.name;
  record.type = block.practice ? terms::TrialType::practice : row.type;
  record.procedure = row.procedure;
  record.level = row.level;
  record.right_choice = index_of(row.correct_response, protocol);
  record.response = index_of(row.response, protocol);
  record.correct = row.correct;
  if (protocol.task.present) record.present = protocol::holds(*protocol.task.present, factors_of(row));
  if (row.response &&
      (protocol.task.kind == protocol::TaskKind::adjustment || protocol::judges(protocol.task)))
    record.setting = text::read_number(*row.response);
  record.start_side = side_of(row, protocol);
  record.confidence = row.confidence;
  record.outcome = row.outcome;
  record.response_time_s = row.response_time_s;
  record.deadline_s = row.deadline_s;
  const auto factors = factors_of(row);
  record.anticipation_s = protocol::evaluate(protocol.timing.anticipation_s, factors);
  if (protocol.timing.signal) record.signal_s = protocol::evaluate(protocol.timing.signal->after_s, factors);
  record.instruction = protocol::condition_of(protocol, factors, block.instruction);
  if (protocol.analysis.difficulty)
    record.difficulty = protocol::evaluate(*protocol.analysis.difficulty, factors);
  return record;
}

/// Adds what force cells measured in a trial, unless the trial is practice or was not answered.
void add_finger(const records::TrialRow& row, const analysis::TrialRecord& trial, report::SessionData& data) {
  const auto& finger = row.finger;
  if (finger.sensing.empty() || trial.type == terms::TrialType::practice ||
      trial.outcome != terms::Outcome::answered)
    return;
  analysis::FingerTrial added;
  added.trial_index = row.trial_index;
  added.condition = trial.instruction;
  // `sensing` does not show whether forces were measured: it may also say that the finger moved too fast
  added.measured = finger.contact_s.has_value();
  added.normal_N = finger.normal_N;
  added.speed_mm_s = finger.speed_mm_s;
  added.mu_low = finger.mu_low;
  added.mu_high = finger.mu_high;
  added.planned_mm = row.boundary_mm;
  added.felt_mm = finger.boundary_felt_mm;
  added.felt_se_mm = finger.boundary_se_mm;
  data.finger.push_back(std::move(added));
}

/// True for a block in which the finger only strokes the surface and no question is asked.
bool nothing_asked(const protocol::Protocol& protocol, const std::string& block) {
  return std::any_of(protocol.plan.begin(), protocol.plan.end(), [&](const auto& part) {
    return protocol::block_of(part).name == block &&
           protocol::block_of(part).kind != protocol::BlockKind::trials;
  });
}

/// True if the trial was presented again because the finger did not move in the way that the protocol asks
/// for.
bool moved_otherwise(const records::TrialRow& row) {
  const auto& sensing = row.finger.sensing;
  return row.outcome == terms::Outcome::fault &&
         (sensing == "strokes" || sensing == "light" || sensing == "hard" || sensing == "slow" ||
          sensing == "fast");
}

report::Design design_of(const protocol::Protocol& protocol, const protocol::AnswerRule& rule,
                         const std::vector<analysis::TrialRecord>& trials) {
  if (protocol.task.kind == protocol::TaskKind::adjustment) return report::Design::adjustment;
  if (protocol.task.value && protocol.task.value->typed) return report::Design::numbers;
  if (protocol::judges(protocol.task)) return report::Design::ratings;
  if (protocol.task.kind == protocol::TaskKind::same_different) return report::Design::same_different;
  if (rule.kind == protocol::AnswerKind::presence) return report::Design::yes_no;
  if (rule.kind == protocol::AnswerKind::category ||
      (protocol.task.choices.size() > 2 && protocol.task.kind == protocol::TaskKind::single_interval &&
       protocol.task.correct_answer.empty()))
    return report::Design::categories;
  bool below = false, above = false;
  for (const auto& trial : trials) {
    below = below || trial.level.value_or(0) < 0;
    above = above || trial.level.value_or(0) > 0;
  }
  const bool sides =
      protocol.task.kind == protocol::TaskKind::single_interval && protocol.task.choices.size() == 2;
  return sides && below && above ? report::Design::two_sided : report::Design::forced_choice;
}

/// Chooses the function to fit: the one that the protocol's procedure assumes. If no procedure assumes one,
/// chooses a function that suits the levels.
void choose_function(const protocol::Protocol& protocol, report::SessionData& data) {
  const bool decibel = data.level_unit == "dB";
  const bool detection = report::has_noise(data.design);
  const bool positive = std::all_of(data.trials.begin(), data.trials.end(), [&](const auto& trial) {
    return !trial.level || *trial.level > 0 || (detection && trial.right_choice != data.positive);
  });
  const bool rises = data.design == report::Design::forced_choice || detection;
  data.function = terms::Function::normal;
  if (rises && (decibel || positive)) data.function = terms::Function::weibull;
  data.scale = rises && positive && !decibel ? analysis::Scale::log10 : analysis::Scale::linear;
  for (const auto& spec : protocol.procedures) {
    if (procedure::description(spec.kind).choice != procedure::Choice::posterior) continue;
    if (spec.signal_detection) continue;  // the fit has no criterion, but a rate of false alarms
    // A Weibull function needs levels above 0, or levels in dB.
    if (spec.function != terms::Function::weibull || decibel || positive) data.function = spec.function;
    return;
  }
}

using analysis::Range;

/// Returns the range of the levels that an adaptive procedure can present. The range also includes the
/// thresholds of the procedure's grid.
Range levels_of(const procedure::Spec& spec, const protocol::Protocol& protocol) {
  Range range{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  const auto include = [&range](double level) {
    range = {std::min(range.first, level), std::max(range.second, level)};
  };
  for (const double level : spec.stimuli.values) include(level);
  for (const double level : spec.threshold.values) include(level);
  if (spec.start) include(*spec.start);
  if (spec.min) include(*spec.min);
  if (spec.max) include(*spec.max);
  if (spec.stimuli.values.empty() && !(spec.min && spec.max))
    for (const auto& factor : protocol.factors)
      if (factor.name == spec.level && factor.range)
        include(factor.range->first), include(factor.range->second);
  return range;
}

/// A logarithmic axis cannot start at 0. If a range of levels starts at 0, the axis starts at this fraction
/// of its upper end (60 dB below it).
constexpr double kLowestRatio = 1e-3;

/// True if the slopes of a procedure's grid have the same meaning as the slope of the fit.
bool same_function(const procedure::Spec& spec, const report::SessionData& data) {
  const bool linear = spec.scale == procedure::Scale::linear;
  return linear == (data.scale == analysis::Scale::linear) && spec.function == data.function;
}

/// Returns the prior for the intervals that are computed from a posterior. It depends only on the levels that
/// the protocol can present, never on the answers. Empty if no procedure is adaptive.
std::optional<analysis::Prior> prior_of(const protocol::Protocol& protocol, const report::SessionData& data) {
  std::optional<Range> levels, slopes;
  const auto widen = [](std::optional<Range>& range, const Range& by) {
    range = range ? Range{std::min(range->first, by.first), std::max(range->second, by.second)} : by;
  };
  for (const auto& spec : protocol.procedures) {
    if (!procedure::follows_answers(spec)) continue;
    widen(levels, levels_of(spec, protocol));
    if (same_function(spec, data) && !spec.signal_detection)
      for (const double slope : spec.slope.values) widen(slopes, {slope, slope});
  }
  if (!levels) return std::nullopt;
  // In a yes/no task only the magnitude of the level matters.
  if (data.design == report::Design::yes_no)
    levels = Range{0, std::max(std::fabs(levels->first), std::fabs(levels->second))};
  if (data.scale == analysis::Scale::log10)
    levels->first = std::max(levels->first, levels->second * kLowestRatio);
  return analysis::prior_around(data.function, data.scale, *levels, slopes);
}

/// Derives the axis label from the factor's name: `contrast_dB` gives `Contrast` and `dB`. In a yes/no task
/// the levels have no sign.
void set_level_words(const std::string& level, report::SessionData& data) {
  const auto words = protocol::words_of(level);
  auto name = level.empty() ? std::string("level") : words.name;
  if (data.design == report::Design::yes_no &&
      std::any_of(data.trials.begin(), data.trials.end(),
                  [](const auto& trial) { return trial.level.value_or(0) < 0; })) {
    name = "size of " + name;
    for (auto& trial : data.trials)
      if (trial.level) trial.level = std::fabs(*trial.level);
  }
  data.level_unit = words.unit;
  data.level_label = axis_label(name, words.unit);
}

}  // namespace

std::vector<const records::BlockRecord*> last_attempts(const std::vector<records::BlockRecord>& blocks) {
  std::map<int, const records::BlockRecord*> last;
  for (const auto& block : blocks) {
    auto& entry = last[block.start.block_index];
    if (!entry || block.start.attempt >= entry->start.attempt) entry = &block;
  }
  std::vector<const records::BlockRecord*> result;
  for (const auto& [index, block] : last) result.push_back(block);
  return result;
}

std::vector<analysis::Deciding> deciding_in(protocol::TaskKind kind) {
  using analysis::Deciding;
  if (kind == protocol::TaskKind::several_intervals) return {Deciding::largest};
  if (kind == protocol::TaskKind::abx || kind == protocol::TaskKind::match_to_sample)
    return {Deciding::independent, Deciding::differencing};
  return {};
}

void add_trials(const std::vector<records::BlockRecord>& blocks, const protocol::Protocol& protocol,
                report::SessionData& data) {
  const auto counted = last_attempts(blocks);
  std::map<std::optional<double>, analysis::RepeatedTrials> repeats;
  for (const auto* block : counted) {
    if (nothing_asked(protocol, block->start.name)) continue;
    for (const auto& row : block->trials) {
      if (!block->start.practice && protocol.sensing && protocol.sensing->repeats > 0) {
        auto& at = repeats[row.level];
        at.level = row.level;
        ++at.presented;
        at.repeated += moved_otherwise(row) ? 1 : 0;
      }
      data.trials.push_back(record_of(row, block->start, protocol));
      add_finger(row, data.trials.back(), data);
    }
  }
  for (const auto& [level, at] : repeats) data.repeats.push_back(at);
  const auto level = protocol.procedures.empty() ? std::string() : protocol.procedures.front().level;
  const auto rule = protocol::answer_rule(protocol, level);
  data.positive = rule.positive;
  data.design = design_of(protocol, rule, data.trials);
  data.scored =
      protocol.task.kind != protocol::TaskKind::single_interval || !protocol.task.correct_answer.empty();
  set_level_words(level, data);
  data.alternatives = std::max(2, static_cast<int>(protocol.task.choices.size()));
  data.deciding = deciding_in(protocol.task.kind);
  choose_function(protocol, data);
  data.prior = prior_of(protocol, data);
  for (const auto& choice : protocol.task.choices) data.choices.push_back(choice.id);
  data.conditions = protocol::conditions(protocol);
  data.show = protocol.analysis.show;
  data.exclusion = {protocol.analysis.exclude_below_s, protocol.analysis.exclude_mad};
  data.thresholds_differ =
      std::any_of(protocol.procedures.begin(), protocol.procedures.end(), [&](const procedure::Spec& spec) {
        const auto& by = protocol.analysis.by;
        return spec.second && std::find(by.begin(), by.end(), spec.second->level) == by.end();
      });
}

}  // namespace turnpoint::report

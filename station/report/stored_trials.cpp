#include "station/report/stored_trials.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "station/analysis/psychometric_posterior.hpp"
#include "station/core/number.hpp"
#include "station/procedure/description.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/conditions.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"
#include "station/report/stored_estimates.hpp"
#include "station/report/words.hpp"

namespace turnpoint::report {

namespace {

std::optional<int> index_of(const std::optional<std::string>& id, const protocol::Protocol& protocol) {
  if (!id) return std::nullopt;
  const auto& choices = protocol.task.choices;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (choices[i].id == *id) return static_cast<int>(i);
  return std::nullopt;
}

protocol::Factors factors_of(const core::TrialRow& row) {
  protocol::Factors factors;
  for (const auto& [name, value] : row.factors)
    std::visit([&factors, &key = name](const auto& v) { factors[key] = v; }, value);
  return factors;
}

/// Returns the side from which a slider started.
analysis::StartSide side_of(const core::TrialRow& row, const protocol::Protocol& protocol) {
  const auto* spec = protocol::find_procedure(protocol, row.procedure);
  if (!spec || spec->kind != procedure::Kind::adjustment || !row.level) return analysis::StartSide::none;
  const auto has = [&](const std::vector<double>& starts) {
    return std::find(starts.begin(), starts.end(), *row.level) != starts.end();
  };
  return has(spec->ascending.values)    ? analysis::StartSide::below
         : has(spec->descending.values) ? analysis::StartSide::above
                                        : analysis::StartSide::none;
}

analysis::TrialRecord record_of(const core::TrialRow& row, const core::BlockStart& block,
                                const protocol::Protocol& protocol) {
  analysis::TrialRecord record;
  record.trial_index = row.trial_index;
  record.block_index = block.block_index;
  record.segment_index = row.segment_index;
  record.block = block.name;
  record.type = block.practice ? core::TrialType::practice : row.type;
  record.procedure = row.procedure;
  record.level = row.level;
  record.right_choice = index_of(row.correct_response, protocol);
  record.response = index_of(row.given.response, protocol);
  record.correct = row.given.correct;
  record.unsure = row.given.response == protocol::kUnsure && !protocol.task.unsure.empty();
  if (protocol.task.present) record.present = protocol::holds(*protocol.task.present, factors_of(row));
  if (row.given.response &&
      (protocol.task.kind == protocol::TaskKind::adjustment || protocol::judges(protocol.task)))
    record.setting = core::read_number(*row.given.response);
  record.start_side = side_of(row, protocol);
  record.confidence = row.given.confidence;
  record.outcome = row.outcome;
  record.response_time_s = row.timing.response_time_s;
  record.duration_s = row.timing.duration_s;
  record.points = row.given.points;
  record.deadline_s = row.timing.deadline_s;
  const auto factors = factors_of(row);
  record.anticipation_s = protocol::evaluate(protocol.timing.anticipation_s, factors);
  if (protocol.task.kind == protocol::TaskKind::two_interval && row.given.correct &&
      !protocol.task.correct_answer.empty())
    for (int scene = 0; scene < 2; ++scene)
      for (const auto& [name, comparison] : protocol.task.correct_answer)
        if (name == protocol::scene_of(protocol.task, scene) && protocol::holds(comparison, factors))
          record.right_scene = scene, record.chosen_scene = *row.given.correct ? scene : 1 - scene;
  if (const auto* spec = protocol::find_procedure(protocol, row.procedure);
      spec && protocol.task.kind == protocol::TaskKind::comparison)
    record.compared = protocol::compared(*spec, factors);
  if (protocol.timing.signal) record.signal_s = protocol::evaluate(protocol.timing.signal->after_s, factors);
  record.instruction = protocol::condition_of(protocol, factors, block.instruction);
  const auto known = [&factors](const std::string& name) {
    const auto found = factors.find(name);
    return found != factors.end() && std::holds_alternative<double>(found->second);
  };
  // a factor may have a value in the trials of some procedures only
  if (const auto& difficulty = protocol.analysis.difficulty;
      difficulty && std::ranges::all_of(protocol::factors_in(*difficulty), known))
    record.difficulty = protocol::evaluate(*protocol.analysis.difficulty, factors);
  return record;
}

/// Adds what force cells measured in a trial, unless the trial is practice or was not answered.
void add_finger(const core::TrialRow& row, const analysis::TrialRecord& trial, SessionData& data) {
  const auto& finger = row.finger;
  if (finger.sensing.empty() || trial.type == core::TrialType::practice ||
      trial.outcome != core::Outcome::answered)
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
  added.planned_mm = row.presented.boundary_mm;
  added.felt_mm = finger.boundary_felt_mm;
  added.felt_se_mm = finger.boundary_se_mm;
  data.finger.push_back(std::move(added));
}

void add_followed(const core::TrialRow& row, const analysis::TrialRecord& trial, SessionData& data) {
  if (!row.follow.followed.empty() && trial.type != core::TrialType::practice &&
      trial.outcome == core::Outcome::answered)
    data.followed.push_back({row.trial_index, trial.instruction, row.follow});
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
bool moved_otherwise(const core::TrialRow& row) {
  const auto& sensing = row.finger.sensing;
  return row.outcome == core::Outcome::fault && (sensing == "strokes" || sensing == "light" ||
                                                 sensing == "hard" || sensing == "slow" || sensing == "fast");
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
bool same_function(const procedure::Spec& spec, const protocol::Meaning& meaning) {
  const bool linear = spec.scale == procedure::Scale::linear;
  return linear != meaning.log_axis && spec.function == meaning.function;
}

/// Returns the prior for the intervals that are computed from a posterior. It depends only on the levels that
/// the protocol can present, never on the answers. Empty if no procedure is adaptive.
std::optional<analysis::Prior> prior_of(const protocol::Protocol& protocol,
                                        const protocol::Meaning& meaning) {
  std::optional<Range> levels, slopes;
  const auto widen = [](std::optional<Range>& range, const Range& by) {
    range = range ? Range{std::min(range->first, by.first), std::max(range->second, by.second)} : by;
  };
  for (const auto& name : meaning.procedures) {
    const auto& spec = *protocol::find_procedure(protocol, name);
    if (!procedure::follows_answers(spec)) continue;
    widen(levels, levels_of(spec, protocol));
    if (same_function(spec, meaning) && !spec.signal_detection)
      for (const double slope : spec.slope.values) widen(slopes, {slope, slope});
  }
  if (!levels) return std::nullopt;
  // In a yes/no task only the magnitude of the level matters.
  if (meaning.size || meaning.design == Design::yes_no)
    levels = Range{0, std::max(std::fabs(levels->first), std::fabs(levels->second))};
  if (meaning.log_axis) levels->first = std::max(levels->first, levels->second * kLowestRatio);
  const auto scale = meaning.log_axis ? analysis::Scale::log10 : analysis::Scale::linear;
  return analysis::prior_around(meaning.function, scale, *levels, slopes);
}

/// Fills in one analysis. The label of its axis follows from the factor's name: `contrast_dB` gives
/// `Contrast` and `dB`.
LevelAnalysis analysis_of(const protocol::Protocol& protocol, const protocol::Meaning& meaning) {
  LevelAnalysis part;
  part.name = meaning.name;
  part.meaning = protocol::in_words(meaning, protocol);
  part.design = meaning.design;
  part.function = meaning.function;
  part.scale = meaning.log_axis ? analysis::Scale::log10 : analysis::Scale::linear;
  part.positive = meaning.rule.positive;
  part.cut = meaning.rule.cut;
  if (protocol.task.kind == protocol::TaskKind::two_interval && meaning.design == Design::two_sided)
    part.scenes = {protocol::scene_of(protocol.task, 0), protocol::scene_of(protocol.task, 1)};
  part.thresholds_differ = !meaning.along.empty();
  const auto words = protocol::words_of(meaning.level);
  auto name = meaning.level.empty() ? std::string("level") : words.name;
  if (meaning.size) name = "size of " + name;
  part.level_unit = words.unit;
  // in a comparison there is one in each interval, each with a factor of its own
  part.level_label = scales(meaning.design)
                         ? in_unit(core::phrase("figure.stimulus"), core::plain(words.unit))
                         : axis_label(name, words.unit);
  if (scales(meaning.design))
    for (const auto& procedure : meaning.procedures)
      if (const auto* spec = protocol::find_procedure(protocol, procedure))
        part.stimuli[procedure] = spec->values;
  part.prior = prior_of(protocol, meaning);
  part.conditions = protocol::conditions(protocol);
  for (auto& condition : part.conditions) condition = protocol::condition_in(meaning, condition);
  if (part.conditions.empty() && !meaning.name.empty()) part.conditions.push_back(meaning.name);
  return part;
}

/// Fills in all analyses, and what they have in common.
void set_analyses(const protocol::Protocol& protocol, SessionData& data) {
  std::vector<LevelAnalysis> parts;
  for (const auto& meaning : protocol.meanings) parts.push_back(analysis_of(protocol, meaning));
  static_cast<LevelAnalysis&>(data) = parts.front();
  if (parts.size() < 2) return;
  data.name.clear(), data.meaning.clear(), data.conditions.clear();
  for (const auto& part : parts) {
    data.conditions.insert(data.conditions.end(), part.conditions.begin(), part.conditions.end());
    data.stimuli.insert(part.stimuli.begin(), part.stimuli.end());
    if (part.level_label != data.level_label) data.level_label = in_unit(core::phrase("figure.level"), {});
    if (part.level_unit != parts.front().level_unit) data.level_unit.clear();
  }
  data.parts = std::move(parts);
}

/// Assigns a trial to its analysis.
void assign(const protocol::Protocol& protocol, analysis::TrialRecord& trial) {
  trial.part = protocol::meaning_of(protocol, trial.procedure, trial.block);
  const auto& meaning = protocol.meanings.at(trial.part);
  if (meaning.size && trial.level) trial.level = std::fabs(*trial.level);
  trial.instruction = protocol::condition_in(meaning, trial.instruction);
}

}  // namespace

std::vector<const core::BlockRecord*> last_attempts(const std::vector<core::BlockRecord>& blocks) {
  std::map<int, const core::BlockRecord*> last;
  for (const auto& block : blocks) {
    auto& entry = last[block.start.block_index];
    if (!entry || block.start.attempt >= entry->start.attempt) entry = &block;
  }
  std::vector<const core::BlockRecord*> result;
  for (const auto& [index, block] : last) result.push_back(block);
  return result;
}

std::vector<core::BlockRecord> of_task(std::vector<core::BlockRecord> blocks,
                                       const protocol::Protocol& protocol, std::size_t task) {
  if (protocol.by_task.empty()) return blocks;
  for (auto& block : blocks)
    std::erase_if(block.trials, [&](const auto& row) {
      return protocol::task_of(protocol, row.procedure, block.start.name) != task;
    });
  return blocks;
}

std::vector<analysis::Deciding> deciding_in(protocol::TaskKind kind) {
  using analysis::Deciding;
  if (kind == protocol::TaskKind::several_intervals) return {Deciding::largest};
  if (kind == protocol::TaskKind::abx || kind == protocol::TaskKind::match_to_sample)
    return {Deciding::independent, Deciding::differencing};
  return {};
}

void add_trials(const std::vector<core::BlockRecord>& blocks, const protocol::Protocol& protocol,
                SessionData& data) {
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
      assign(protocol, data.trials.back());
      add_finger(row, data.trials.back(), data);
      add_followed(row, data.trials.back(), data);
    }
  }
  for (const auto& [level, at] : repeats) data.repeats.push_back(at);
  set_analyses(protocol, data);
  data.task = protocol.task.name;
  data.scored = protocol::scored(protocol.task);
  data.alternatives = std::max(2, static_cast<int>(protocol.task.choices.size()));
  data.deciding = deciding_in(protocol.task.kind);
  data.unsure = !protocol.task.unsure.empty();
  data.payoff = protocol.payoff.has_value();
  data.signalled = protocol.timing.signal.has_value();
  for (const auto& choice : protocol.task.choices) data.choices.push_back(choice.id);
  data.show = protocol.analysis.show;
  data.holm = protocol.analysis.holm;
  data.exclusion = {protocol.analysis.exclude_below_s, protocol.analysis.exclude_mad};
}

void add_other_trials(const std::vector<core::BlockRecord>& blocks, const protocol::Protocol& protocol,
                      std::size_t task, SessionData& data) {
  for (std::size_t other = 0; other < protocol.by_task.size(); ++other) {
    if (other == task) continue;
    SessionData more;
    add_trials(of_task(blocks, protocol, other), protocol.by_task[other], more);
    data.other_trials.insert(data.other_trials.end(), more.trials.begin(), more.trials.end());
  }
}

}  // namespace turnpoint::report

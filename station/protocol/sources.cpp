#include "station/protocol/sources.hpp"

#include <algorithm>

#include "station/procedure/limits.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/follow_target.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

void add(const Linear& expression, std::set<std::string>& names) {
  for (const auto& name : factors_in(expression)) names.insert(name);
}

void add_steps(double low, double high, int steps, std::vector<double>& levels) {
  for (int i = 0; i <= steps; ++i) levels.push_back(low + (high - low) * i / steps);
}

// A staircase can present any level between its limits, a series of the method of limits those that are whole
// steps from its start, and a slider any value in the range of its factor. Evenly spaced values represent the
// levels of a staircase and of a slider.
std::vector<double> levels_of(const Protocol& protocol, const procedure::Spec& spec) {
  auto levels = spec.values;
  levels.insert(levels.end(), spec.stimuli.values.begin(), spec.stimuli.values.end());
  if (spec.start) levels.push_back(*spec.start);
  constexpr int steps = 24;
  const auto of_series = spec.kind == procedure::Kind::limits ? procedure::levels_of_series(spec, steps + 1)
                                                              : std::vector<double>{};
  levels.insert(levels.end(), of_series.begin(), of_series.end());
  if (of_series.empty() && spec.min && spec.max) add_steps(*spec.min, *spec.max, steps, levels);
  const auto* factor = find_factor(protocol.factors, spec.level);
  if (spec.kind == procedure::Kind::adjustment && factor && factor->range)
    add_steps(factor->range->first, factor->range->second, 4, levels);
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

void add_block(const Protocol& protocol, const Block& block, const std::string& over,
               std::vector<Source>& sources) {
  std::set<std::string> fixed;
  for (const auto& [name, value] : block.fixed) fixed.insert(name);
  if (!over.empty()) fixed.insert(over);
  const auto push = [&](const core::Phrase& what, const std::string& level, std::vector<double> levels,
                        const procedure::Spec* spec) {
    auto sets = fixed;
    sets.insert(level);
    if (spec) sets.insert(spec->balance.begin(), spec->balance.end());
    if (spec)
      for (const auto& [name, value] : spec->with) sets.insert(name);
    if (spec) sets.insert(spec->against.begin(), spec->against.end());
    Source source;
    source.block = &block, source.what = what, source.level = level, source.spec = spec;
    source.levels = std::move(levels);
    if (spec && spec->second) {
      source.second = spec->second->level, source.seconds = spec->second->stimuli.values;
      sets.insert(source.second);
    }
    source.sets = std::move(sets);
    sources.push_back(std::move(source));
  };
  for (const auto& name : block.procedures)
    if (const auto* spec = find_procedure(protocol, name); spec && !spec->level.empty())
      push(phrase("procedure \"%1\"", {plain(name)}), spec->level, levels_of(protocol, *spec), spec);
  if (!block.level.empty()) push(phrase("fixed levels"), block.level, block.levels, nullptr);
  if (block.catch_trials && !block.catch_trials->factor.empty())
    push(phrase("catch trials"), block.catch_trials->factor, block.catch_trials->levels, nullptr);
}

}  // namespace

std::vector<const Linear*> expressions_of(const Scene& scene) {
  std::vector<const Linear*> all;
  const auto add = [&](const std::optional<Linear>& expression) {
    if (expression) all.push_back(&*expression);
  };
  for (const auto* expression :
       {&scene.boundary_mm, &scene.displacement_um, &scene.friction, &scene.displacement_under_finger_um,
        &scene.finger_mm, &scene.friction_contrast_dB})
    add(*expression);
  if (scene.zone) {
    add(scene.zone->friction);
    const auto& design = scene.zone->design_friction;
    if (design && scene.zone->friction && design->source != scene.zone->friction->source) add(design);
  }
  for (const auto& tone : scene.tones) {
    add(tone.boundary_mm), add(tone.frequency_Hz);
    all.push_back(&tone.displacement_um);
  }
  if (scene.follow) {
    const auto followed = expressions_of(*scene.follow);
    all.insert(all.end(), followed.begin(), followed.end());
  }
  return all;
}

std::vector<Source> sources_of(const Protocol& protocol) {
  std::vector<Source> sources;
  for (const auto& part : protocol.plan) {
    const auto* sequence = std::get_if<Sequence>(&part);
    add_block(protocol, block_of(part), sequence ? sequence->over : "", sources);
  }
  return sources;
}

std::vector<std::string> scenes_used(const Protocol& protocol) {
  std::vector<std::string> names;
  for (const auto& one : protocol.by_task)
    for (const auto& name : scenes_used(one))
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  if (!protocol.by_task.empty()) return names;
  const auto add_name = [&](const std::string& name) {
    if (protocol.scenes.count(name) && std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  };
  const auto& task = protocol.task;
  const auto add_interval = [&](const std::vector<std::string>& interval) {
    for (const auto& part : parts_of(task, interval))
      for (const auto& name : part.scenes) add_name(name);
  };
  for (const auto& part : task.before)
    for (const auto& name : part.scenes) add_name(name);
  for (const auto& interval : task.intervals) add_interval(interval);
  add_interval({task.standard}), add_interval({task.target});
  if (protocol.timing.signal) add_name(protocol.timing.signal->scene);
  return names;
}

std::set<std::string> factors_used(const Protocol& protocol) {
  std::set<std::string> names;
  for (const auto& one : protocol.by_task) names.merge(factors_used(one));
  if (!protocol.by_task.empty()) return names;
  for (const auto& name : scenes_used(protocol))
    for (const auto* expression : expressions_of(protocol.scenes.at(name))) add(*expression, names);
  for (const auto& [id, comparison] : protocol.task.correct_answer)
    add(comparison.left, names), add(comparison.right, names);
  if (const auto& present = protocol.task.present) add(present->left, names), add(present->right, names);
  const auto& timing = protocol.timing;
  for (const auto& time : stimulus_times(protocol.task)) add(time, names);
  add(protocol.task.cue_s, names);
  if (timing.iti_s.expression) add(*timing.iti_s.expression, names);
  add(timing.anticipation_s, names);
  for (const auto* delay : {&timing.delay_s.wrong, &timing.delay_s.late, &timing.delay_s.early})
    add(*delay, names);
  if (const auto& payoff = protocol.payoff) {
    for (const auto* points :
         {&payoff->right, &payoff->wrong, &payoff->late, &payoff->early, &payoff->unsure})
      add(*points, names);
    if (payoff->fast) add(payoff->fast->below_s, names), add(payoff->fast->points, names);
  }
  if (timing.deadline_s) add(*timing.deadline_s, names);
  if (timing.signal) add(timing.signal->after_s, names);
  for (const auto& [name, instruction] : protocol.instructions)
    if (instruction.deadline_s) add(*instruction.deadline_s, names);
  return names;
}

std::vector<FactorValue> drawn_values(const Factor& factor) {
  if (factor.draw != FactorDraw::uniform && factor.draw != FactorDraw::normal) return factor.levels;
  std::vector<double> values;
  if (factor.range) add_steps(factor.range->first, factor.range->second, 4, values);
  return {values.begin(), values.end()};
}

Factors any_factors(const Protocol& protocol) {
  Factors factors;
  for (const auto& factor : protocol.factors) {
    if (!factor.levels.empty())
      factors[factor.name] = factor.levels.front();
    else if (factor.range)
      factors[factor.name] = 0.5 * (factor.range->first + factor.range->second);
    else
      factors[factor.name] = 0.0;  // the factor has neither a range nor levels; read_factors() reports this
  }
  return factors;
}

const procedure::Spec* find_procedure(const Protocol& protocol, const std::string& name) {
  for (const auto& spec : protocol.procedures)
    if (spec.name == name) return &spec;
  return nullptr;
}

bool is_program(const Protocol& protocol, const std::string& name) {
  const auto* spec = find_procedure(protocol, name);
  return spec != nullptr && spec->kind == procedure::Kind::program;
}

const Block& block_of(const std::variant<Block, Sequence>& part) {
  const auto* block = std::get_if<Block>(&part);
  return block ? *block : std::get<Sequence>(part).block;
}

std::vector<Block> all_blocks(const Protocol& protocol) {
  std::vector<Block> blocks;
  for (const auto& part : protocol.plan) {
    const auto* sequence = std::get_if<Sequence>(&part);
    const auto* factor = sequence ? find_factor(protocol.factors, sequence->over) : nullptr;
    if (!sequence) blocks.push_back(block_of(part));
    if (!factor) continue;
    for (const auto& level : factor->levels) {
      blocks.push_back(sequence->block);
      blocks.back().fixed[factor->name] = level;
    }
  }
  return blocks;
}

const Linear* deadline_of_instruction(const Protocol& protocol, const Block& block) {
  const auto fixed = block.fixed.find("instruction");
  const auto* name = fixed == block.fixed.end() ? nullptr : std::get_if<std::string>(&fixed->second);
  const auto found = name != nullptr ? protocol.instructions.find(*name) : protocol.instructions.end();
  return found != protocol.instructions.end() && found->second.deadline_s ? &*found->second.deadline_s
                                                                          : nullptr;
}

}  // namespace turnpoint::protocol

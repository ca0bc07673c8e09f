#include "station/rehearsal/trial_census.hpp"

#include <algorithm>

#include "station/procedure/description.hpp"
#include "station/procedure/program.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/visits.hpp"

namespace turnpoint::rehearsal {

namespace {

using procedure::follows_answers;
using protocol::Block;
using protocol::Protocol;
using trial::TrialSpec;

constexpr int most_trials_of_a_block = 20'000, enough_trials = 40'000;

double trials_of(const procedure::Spec& spec) {
  if (!follows_answers(spec)) return static_cast<double>(procedure::list_trials(spec));
  if (spec.kind == procedure::Kind::limits) return procedure::series_trials(spec);
  return spec.stop.trials.value_or(spec.stop.reversals ? 6 * *spec.stop.reversals : 60);
}

double trials_of(const Protocol& protocol, const Block& block) {
  double trials = 0;
  for (const auto& name : block.procedures)
    if (const auto* spec = protocol::find_procedure(protocol, name)) trials += trials_of(*spec);
  return trials;
}

// True if the first trials of this block differ, on average, from the later ones. In a shuffled list they do
// not differ, because every part of the list has the same trials on average.
bool begins_unlike_it_goes_on(const Protocol& protocol, const Block& block) {
  if (block.practice || !block.trials || *block.trials >= trials_of(protocol, block)) return false;
  bool unlike = block.procedures.size() > 1;
  for (const auto& name : block.procedures) {
    const auto* spec = protocol::find_procedure(protocol, name);
    if (!spec || follows_answers(*spec)) return false;
    unlike =
        unlike || spec->shuffle == procedure::Shuffle::none || !spec->max_run.empty() || !spec->rules.empty();
  }
  return unlike;
}

// True if a procedure outside practice chooses the levels from the answers.
bool sets_levels(const protocol::Source& source) {
  return source.spec && !source.block->practice && follows_answers(*source.spec);
}

// Calls count(block, trial) for each trial of a session.
template <typename Count>
void run_session(const Protocol& protocol, const protocol::Visit& visit, std::uint64_t seed,
                 const Answers& answers, Count&& count) {
  procedure::StandIns programs;
  trial::Director director(protocol, visit, seed, &programs);
  while (const auto* block = director.block()) {
    int trials = 0;
    while (const auto trial = director.next()) {
      count(*block, *trial);
      trial::TrialEnd end;
      end.response = trial->strokes ? 0 : answers(*trial);
      if (trial->correct) end.correct = end.response == trial->correct;
      // Mark practice as passed, because a participant who fails it never sees the other blocks.
      if (block->practice) end.correct = true;
      director.record(end);
      if (++trials > most_trials_of_a_block) return;
    }
    director.finish_block();
  }
}

}  // namespace

TrialCensus::TrialCensus(const Protocol& protocol) : protocol_(&protocol) {
  const auto used = protocol::factors_used(protocol);
  for (const auto& factor : protocol.factors)
    if (used.count(factor.name)) relevant_.push_back(&factor);
}

void TrialCensus::add(const Block& block, const procedure::Spec* spec, const std::vector<double>& levels,
                      const std::vector<double>& seconds, double trials) {
  protocol::Factors fixed;
  for (const auto* factor : relevant_)
    if (const auto found = block.fixed.find(factor->name); found != block.fixed.end()) fixed.insert(*found);
  for (const auto* factor : relevant_)
    if (spec)
      if (const auto found = spec->with.find(factor->name); found != spec->with.end())
        fixed[factor->name] = found->second;
  const auto matters = [&](const std::string& name) {
    return std::any_of(relevant_.begin(), relevant_.end(), [&](const auto* f) { return f->name == name; });
  };
  const auto count = [&](protocol::Factors cell, const std::string& name, const std::vector<double>& values,
                         double of_these) {
    for (const double value : values) {
      if (matters(name)) cell[name] = value;
      cells_[cell] += of_these / static_cast<double>(values.size());
    }
  };
  const auto& level = spec ? spec->level : block.level;
  if (seconds.empty()) count(fixed, level, levels, trials);
  for (const double second : seconds) {
    auto cell = fixed;
    if (matters(spec->second->level)) cell[spec->second->level] = second;
    count(cell, level, levels, trials / static_cast<double>(seconds.size()));
  }
  // Catch trials are presented in addition to the procedure's trials. Before each of these, catch trials are
  // inserted as long as a random draw with probability `rate` succeeds.
  if (const auto& caught = block.catch_trials; caught && spec)
    count(fixed, caught->factor, caught->levels, trials * caught->rate / (1 - caught->rate));
}

void TrialCensus::add(const Block& block, const TrialSpec& trial) {
  if (trial.type != core::TrialType::experimental) return;
  const auto* spec = protocol::find_procedure(*protocol_, trial.procedure);
  std::vector<double> second;
  if (spec && spec->second) second.push_back(std::get<double>(trial.factors.at(spec->second->level)));
  add(block, spec, {trial.level.value_or(0)}, second, 1);
}

std::vector<protocol::Factors> TrialCensus::combinations(const protocol::Factors& cell) const {
  std::vector<protocol::Factors> all{cell};
  for (const auto* factor : relevant_) {
    const auto values = protocol::drawn_values(*factor);
    if (cell.count(factor->name) || values.empty()) continue;
    std::vector<protocol::Factors> next;
    for (const auto& factors : all)
      for (const auto& level : values) {
        next.push_back(factors);
        next.back()[factor->name] = level;
      }
    all = std::move(next);
  }
  return all;
}

bool levels_follow_answers(const Protocol& protocol) {
  const auto sources = protocol::sources_of(protocol);
  return std::any_of(sources.begin(), sources.end(), sets_levels);
}

bool needs_own_sessions(const Protocol& protocol) {
  const auto sources = protocol::sources_of(protocol);
  return std::any_of(sources.begin(), sources.end(), [&](const protocol::Source& source) {
    if (!sets_levels(source) || source.spec->tracks.empty()) return sets_levels(source);
    const auto rule = protocol::answer_rule(protocol, source.level);
    return rule.kind == protocol::AnswerKind::presence || rule.size;
  });
}

TrialCensus census_of_session(const Protocol& protocol, std::uint64_t seed, const Answers& answers) {
  TrialCensus census(protocol);
  for (const auto& visit : protocol::different_visits(protocol))
    run_session(protocol, visit, seed, answers,
                [&](const Block& block, const TrialSpec& trial) { census.add(block, trial); });
  return census;
}

TrialCensus census_of(const Protocol& protocol) {
  TrialCensus census(protocol);
  std::vector<Block> blocks;
  const auto visits = protocol::different_visits(protocol);
  for (const auto& visit : visits)
    for (auto& block : protocol::block_order(protocol, visit)) blocks.push_back(std::move(block));
  const bool sampled = std::any_of(blocks.begin(), blocks.end(), [&](const Block& block) {
    return begins_unlike_it_goes_on(protocol, block);
  });
  int trials = 0;
  const auto count = [&](const Block& block, const TrialSpec& trial) {
    census.add(block, trial);
    trials += block.practice ? 0 : 1;
  };
  for (std::uint64_t seed = 0; sampled && trials < enough_trials && seed < enough_trials; ++seed)
    for (const auto& visit : visits)
      run_session(
          protocol, visit, seed, [](const TrialSpec&) { return 0; }, count);
  if (sampled) return census;
  std::map<const procedure::Spec*, std::vector<double>> levels;
  for (const auto& source : protocol::sources_of(protocol))
    if (source.spec)
      levels[source.spec] = follows_answers(*source.spec) ? source.levels : source.spec->values;
  for (const auto& block : blocks) {
    if (block.practice) continue;
    const double all = trials_of(protocol, block);
    for (const auto& name : block.procedures)
      if (const auto* spec = protocol::find_procedure(protocol, name))
        census.add(block, spec, levels[spec],
                   spec->second ? spec->second->stimuli.values : std::vector<double>{},
                   trials_of(*spec) * (block.trials ? std::min(1.0, *block.trials / all) : 1.0));
    const auto fixed = block.trials.value_or(static_cast<int>(block.levels.size()));
    for (int i = 0; i < fixed && !block.levels.empty(); ++i)
      census.add(block, nullptr, {block.levels[static_cast<std::size_t>(i) % block.levels.size()]}, {}, 1);
  }
  return census;
}

}  // namespace turnpoint::rehearsal

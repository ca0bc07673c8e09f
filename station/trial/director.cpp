#include "station/trial/director.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "station/core/number.hpp"
#include "station/procedure/description.hpp"
#include "station/procedure/state_hash.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/tasks.hpp"
#include "station/trial/director_state.hpp"
#include "station/trial/orders.hpp"
#include "station/trial/timing.hpp"

namespace turnpoint::trial {

using core::Stream;
using protocol::Block;

void Director::State::enter_block() {
  trial = shown = right = 0;
  std::ranges::fill(task_trials, 0);
  spent_s = 0;
  specs.clear();
  procedures.clear();
  practice_levels.clear();
  current.reset();
  last_procedure = no_procedure;
  pass.clear();
  swapped_orders.clear();
  deviation = {};
  catches_owed = 0;
  adapted.clear();
  runs.clear();
  const auto* b = now();
  if (b == nullptr) return;
  block_task = protocol::task_of(protocol, "", b->name);
  for (const auto& name : b->procedures) {
    specs.push_back(find_spec(name));
    const auto key = procedure::key_of(seed, static_cast<int>(block), procedures.size(), attempt);
    procedures.push_back(procedure::make_procedure(*specs.back(), context_for(), key));
    if (const auto before = earlier.find(name); specs.back()->continues && before != earlier.end())
      procedure::continue_from(before->second, *specs.back(), *procedures.back());
  }
  set_limits_of_runs();
  strokes.erase(block);
  if (b->kind == protocol::BlockKind::friction_table)
    practice_levels = friction_table_order(b->strokes.levels_um, b->strokes.repeats,
                                           {seed, Stream::level_order, static_cast<int>(block), attempt, 0});
  if (b->kind == protocol::BlockKind::training)
    practice_levels.assign(static_cast<std::size_t>(b->trials.value()), 0);
  if (!b->levels.empty()) {
    const auto n = static_cast<std::size_t>(b->trials.value_or(static_cast<int>(b->levels.size())));
    for (std::size_t i = 0; i < n; ++i) practice_levels.push_back(b->levels[i % b->levels.size()]);
    draws(Stream::practice, 0).shuffle(practice_levels);
  }
}

const procedure::Spec* Director::State::find_spec(const std::string& name) const {
  for (const auto& spec : protocol.procedures)
    if (spec.name == name) return &spec;
  throw std::out_of_range("the protocol has no procedure named \"" + name + "\"");
}

procedure::Context Director::State::context_for() const {
  procedure::Context context;
  for (const auto& factor : protocol.factors) context.factor_levels[factor.name] = factor.levels.size();
  context.unanswered_are_data = timeouts_are_data();
  context.programs = programs;
  return context;
}

void Director::State::learn(const TrialEnd& end) {
  if (current_procedure == no_procedure) return;
  const auto index = static_cast<std::size_t>(current_procedure);
  const auto& task = seen_by(protocol::task_of(protocol, specs[index]->name, "")).task;
  last_procedure = current_procedure;
  std::erase(pass, current_procedure);
  if (specs[index]->kind == procedure::Kind::adjustment && end.setting &&
      end.outcome == core::Outcome::answered)
    return procedures[index]->record_setting(*end.setting);
  auto answer = procedure::Answer::none;
  if (end.outcome == core::Outcome::answered && end.response)
    answer = protocol::learned_from(*specs[index], protocol::answer_id(task, *end.response), end.correct);
  procedures[index]->record(answer);
}

/// True if the trials of the current block have lasted as long as the block does.
bool Director::State::time_is_up() const { return now()->lasts_s && spent_s >= *now()->lasts_s; }

/// About how long a trial of the current block lasts: as long as those so far or, before the first one, as
/// long as a quick answer takes.
double Director::State::trial_s() const {
  constexpr double quick_s = 0.5;
  return trial > 0 && spent_s > 0 ? spent_s / trial : protocol::quick_trial_s(seen_by(block_task), quick_s);
}

int Director::State::block_expected(const Block& b) const {
  int trials = trials_of(b);
  if (b.lasts_s) trials = std::min(trials, static_cast<int>(std::ceil(*b.lasts_s / trial_s())));
  return trials;
}

/// The number of trials of a block whose time does not end it.
int Director::State::trials_of(const Block& b) const {
  if (!b.levels.empty()) return b.trials.value_or(static_cast<int>(b.levels.size()));
  if (b.trials) return *b.trials;
  double trials = 0;
  for (const auto& name : b.procedures) {
    const auto& spec = *find_spec(name);
    if (spec.kind == procedure::Kind::limits)
      trials += procedure::series_trials(spec);
    else if (procedure::follows_answers(spec))
      trials += spec.stop.trials.value_or(6 * spec.stop.reversals.value_or(8));
    else
      trials += static_cast<double>(procedure::list_trials(spec));
  }
  return static_cast<int>(std::lround(trials * (1 + (b.catch_trials ? b.catch_trials->rate : 0))));
}

/// The number of trials that the current block still has, as far as its procedures know: a trial that is to
/// be repeated is left, and as long as a procedure goes on, at least one is.
int Director::State::left_in_block() const {
  const auto* b = now();
  if (b == nullptr) return 0;
  const int left = left_of_procedures(*b);
  if (!b->lasts_s) return left;
  const double left_s = std::max(0.0, *b->lasts_s - spent_s);
  return std::min(left, static_cast<int>(std::ceil(left_s / trial_s())));
}

/// The same, if its time does not end the block.
int Director::State::left_of_procedures(const Block& b) const {
  if (procedures.empty() || b.trials) return std::max(trials_of(b) - trial, current ? 1 : 0);
  double left = 0;
  for (const auto& procedure : procedures) {
    const int own = procedure->expected() - procedure->recorded();
    left += own > 0 ? own : procedure->ready() && procedure->next() ? 1 : 0;
  }
  left *= 1 + (b.catch_trials ? b.catch_trials->rate : 0);
  return std::max(static_cast<int>(std::lround(left)), current ? 1 : 0);
}

Director::Director(const protocol::Protocol& protocol, const protocol::Visit& visit, std::uint64_t seed,
                   procedure::Programs* programs, procedure::EarlierTrials earlier)
    : state_(std::make_unique<State>(protocol, visit, seed, programs, std::move(earlier))) {}
Director::~Director() = default;
Director::Director(Director&&) noexcept = default;

const Block* Director::block() const { return state_->now(); }
int Director::block_index() const { return static_cast<int>(state_->block); }
int Director::attempt() const { return state_->attempt; }
int Director::blocks() const { return static_cast<int>(state_->blocks.size()); }

std::size_t Director::task() const { return state_->current ? state_->current->task : state_->block_task; }

bool Director::ready() const {
  const auto ready = [](const auto& procedure) { return procedure->ready(); };
  return state_->current || std::ranges::all_of(state_->procedures, ready);
}

std::optional<TrialSpec> Director::next() {
  if (!state_->current) state_->current = state_->make();
  return state_->current;
}

void Director::record(const TrialEnd& end) {
  auto& s = *state_;
  if (!s.current)
    throw std::logic_error("director: record() was called although no trial had been given out");
  s.last_counts = false;
  if (end.outcome == core::Outcome::fault || end.outcome == core::Outcome::aborted) return;
  s.adapted.insert(s.current->task);
  s.count_runs(*s.current);
  const auto type = s.current->type;
  s.last_counts = type != core::TrialType::warmup;
  const auto level = s.current->level;
  const auto task = s.current->task;
  s.current.reset();
  if (type == core::TrialType::warmup) {
    --s.warmups, ++s.warmups_given;
    return;
  }
  s.apply_deviation();
  s.learn(end);
  if (s.now()->kind == protocol::BlockKind::friction_table)
    s.strokes[s.block].push_back({*level, end.friction});
  ++s.trial, ++s.done, ++s.task_trials[task];
  if (type != core::TrialType::catch_trial) ++s.shown;
  if (end.correct.value_or(false)) ++s.right;
}

void Director::spend(double trial_s) {
  auto& s = *state_;
  if (!s.last_counts || s.now() == nullptr) return;
  s.spent_s += trial_s;
  if (s.time_is_up()) s.current.reset();
}

void Director::finish_block() {
  auto& s = *state_;
  const auto* b = s.now();
  if (b == nullptr) return;
  const bool failed = b->pass && s.trial > 0 && s.right < b->pass->accuracy * s.trial;
  if (failed && s.attempt - s.first_attempt < b->pass->retries) {
    ++s.attempt;
  } else if (failed) {
    s.ended = "practice \"" + b->name + "\" was not passed in " + std::to_string(s.attempt + 1) + " attempts";
  } else {
    ++s.block;
    s.attempt = s.first_attempt;
  }
  s.enter_block();
}

void Director::restart_block() {
  ++state_->attempt;
  state_->enter_block();
}

void Director::restart_session() {
  state_->first_attempt = state_->attempt = std::max(state_->first_attempt, state_->attempt) + 1;
  state_->block = 0;
  state_->ended.clear();
  state_->enter_block();
}

void Director::warm_up(int trials) {
  if (const auto* block = state_->now(); block != nullptr && block->kind != protocol::BlockKind::trials)
    return;
  state_->warmups = trials;
  state_->current.reset();
}

void Director::rested() {
  state_->adapted.clear();
  if (auto& current = state_->current) current->fresh = state_->is_fresh(current->task);
}

const std::vector<Director::Stroke>& Director::strokes(int block_index) const {
  static const std::vector<Stroke> none;
  const auto found = state_->strokes.find(static_cast<std::size_t>(block_index));
  return found == state_->strokes.end() ? none : found->second;
}

const std::vector<Block>& Director::all_blocks() const { return state_->blocks; }

const std::string& Director::ended_because() const { return state_->ended; }
int Director::trials_done() const { return state_->done; }

int Director::trials_expected() const {
  const auto& s = *state_;
  int sum = s.done + s.left_in_block();
  for (std::size_t i = s.block + 1; s.now() != nullptr && i < s.blocks.size(); ++i)
    sum += s.block_expected(s.blocks[i]);
  return sum;
}

std::vector<ProcedureEstimate> Director::estimates() const {
  std::vector<ProcedureEstimate> all;
  for (std::size_t i = 0; i < state_->procedures.size(); ++i)
    for (const auto& [parameter, e] : state_->procedures[i]->estimates())
      all.push_back({state_->specs[i]->name, parameter, e.mean, e.sd, e.basis, e.interval});
  return all;
}

const std::map<std::string, Director::LongRun>& Director::long_runs() const { return state_->long_runs; }

std::vector<core::Phrase> Director::early_ends() const {
  std::vector<core::Phrase> all;
  for (const auto& procedure : state_->procedures)
    if (const auto end = procedure->end()) all.push_back(*end);
  return all;
}

std::optional<std::pair<double, std::optional<double>>> Director::threshold() const {
  if (state_->current_procedure == State::no_procedure) return std::nullopt;
  const auto estimates = state_->procedures[static_cast<std::size_t>(state_->current_procedure)]->estimates();
  auto found = estimates.find("threshold");
  if (found == estimates.end()) found = estimates.find("pse");
  if (found == estimates.end()) return std::nullopt;
  return std::pair(found->second.mean, found->second.sd);
}

std::string in_words(const ProcedureEstimate& estimate) {
  std::string rest = estimate.sd ? "SD " + core::number(*estimate.sd, 3) : "";
  if (!estimate.basis.empty()) rest += (rest.empty() ? "" : ", ") + estimate.basis;
  return core::number(estimate.mean, 4) + (rest.empty() ? "" : " (" + rest + ")");
}

std::uint64_t Director::state_hash() const {
  procedure::StateHash hash;
  for (const int word :
       {static_cast<int>(state_->block), state_->attempt, state_->trial, state_->right, state_->done})
    hash.add(static_cast<std::uint64_t>(word));
  for (const auto& p : state_->procedures) hash.add(p->state_hash());
  // Use 63 bits, because the integers of SQLite are signed.
  return hash.value() >> 1;
}

}  // namespace turnpoint::trial

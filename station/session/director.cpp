#include "station/session/director.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "station/procedure/procedure.hpp"
#include "station/procedure/state_hash.hpp"
#include "station/session/trial_orders.hpp"

namespace turnpoint::session {

using protocol::Block;
using random::Draws;
using random::Stream;

namespace {

constexpr int kNoProcedure = -1;

/// The largest |level| that the protocol knows for warm-up: an easy trial on a side drawn at random.
std::vector<double> easy_levels(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (values.empty()) return {};
  return *low < 0 && *high > 0 ? std::vector<double>{*low, *high} : std::vector<double>{*high};
}

}  // namespace

struct Director::State {
  const protocol::Protocol& protocol;
  std::uint64_t seed;
  std::vector<Block> blocks;
  std::size_t block = 0;
  int attempt = 0, first_attempt = 0;  ///< of this block; of a block that is entered
  int trial = 0;                       ///< trials of the block that counted: the key of the next one's draws
  int shown = 0, right = 0;
  int warmups = 0, warmups_given = 0;
  int done = 0, expected_before = 0;
  std::string ended;
  std::vector<const procedure::Spec*> specs;
  std::vector<std::unique_ptr<procedure::Procedure>> procedures;
  std::vector<double> practice_levels;
  std::optional<TrialSpec> current;
  int current_procedure = kNoProcedure;

  State(const protocol::Protocol& p, int sequence_index, std::uint64_t s)
      : protocol(p), seed(s), blocks(protocol::block_order(p, sequence_index)) {
    enter_block();
  }

  const Block* now() const { return ended.empty() && block < blocks.size() ? &blocks[block] : nullptr; }
  Draws draws(Stream stream, int key) const {
    return Draws({seed, stream, static_cast<int>(block), attempt, key});
  }

  void enter_block();
  const procedure::Spec* find_spec(const std::string& name) const;
  procedure::Context context_for(const procedure::Spec& spec) const;
  bool timeouts_are_data() const;
  double deadline() const;
  protocol::Factors drawn_factors() const;
  std::optional<int> pick_procedure() const;
  bool catch_due() const;
  TrialSpec blank(store::TrialType type, Stream stream) const;
  void complete(TrialSpec& spec) const;
  std::optional<SliderSpan> slider(int key) const;
  std::optional<TrialSpec> make();
  TrialSpec warmup_trial() const;
  TrialSpec catch_trial() const;
  std::optional<TrialSpec> practice_trial() const;
  TrialSpec procedure_trial(int index) const;
  void learn(const TrialEnd& end);
  int block_expected(const Block& b) const;
};

void Director::State::enter_block() {
  trial = shown = right = 0;
  specs.clear();
  procedures.clear();
  practice_levels.clear();
  current.reset();
  const auto* b = now();
  if (b == nullptr) return;
  for (const auto& name : b->procedures) {
    specs.push_back(find_spec(name));
    // The place of a procedure in its block keeps the draws of two that interleave apart.
    random::Key key{seed, Stream::level_order, static_cast<int>(block * 64 + procedures.size()), attempt, 0};
    procedures.push_back(procedure::make_procedure(*specs.back(), context_for(*specs.back()), key));
  }
  if (!b->levels.empty()) {
    const auto n = static_cast<std::size_t>(b->trials.value_or(static_cast<int>(b->levels.size())));
    for (std::size_t i = 0; i < n; ++i) practice_levels.push_back(b->levels[i % b->levels.size()]);
    draws(Stream::practice, 0).shuffle(practice_levels);
  }
}

const procedure::Spec* Director::State::find_spec(const std::string& name) const {
  for (const auto& spec : protocol.procedures)
    if (spec.name == name) return &spec;
  throw std::out_of_range("no procedure named \"" + name + "\"");
}

procedure::Context Director::State::context_for(const procedure::Spec& spec) const {
  procedure::Context context;
  for (const auto& factor : protocol.factors) context.factor_levels[factor.name] = factor.levels.size();
  const auto fixed = now()->fixed;
  context.right_answer = [this, fixed, level = spec.level](double value) {
    auto factors = fixed;
    factors[level] = value;
    for (const auto& factor : protocol.factors)
      if (!factors.count(factor.name) && !factor.levels.empty()) factors[factor.name] = factor.levels.front();
    return correct_choice(protocol.task, factors).value_or(-1);
  };
  context.unanswered_are_data = timeouts_are_data();
  return context;
}

bool Director::State::timeouts_are_data() const {
  const auto found = now()->fixed.find("instruction");
  if (found == now()->fixed.end()) return false;
  const auto* name = std::get_if<std::string>(&found->second);
  const auto instruction = name ? protocol.instructions.find(*name) : protocol.instructions.end();
  return instruction != protocol.instructions.end() && instruction->second.deadline_s.has_value();
}

double Director::State::deadline() const {
  if (timeouts_are_data())
    return *protocol.instructions.at(std::get<std::string>(now()->fixed.at("instruction"))).deadline_s;
  return protocol.timing.deadline_s.value_or(0);
}

/// Factors with levels that nothing else sets are drawn; text factors of the block are as it says.
protocol::Factors Director::State::drawn_factors() const {
  auto factors = now()->fixed;
  auto draw = draws(Stream::factor_level, trial);
  for (const auto& factor : protocol.factors)
    if (!factors.count(factor.name) && !factor.levels.empty())
      factors[factor.name] = factor.levels[draw.below(factor.levels.size())];
  return factors;
}

std::optional<int> Director::State::pick_procedure() const {
  std::vector<int> open;
  for (std::size_t i = 0; i < procedures.size(); ++i)
    if (procedures[i]->next()) open.push_back(static_cast<int>(i));
  if (open.empty()) return std::nullopt;
  switch (now()->interleave) {
    case protocol::Interleave::none:
      return open.front();
    case protocol::Interleave::alternate:
      return open[static_cast<std::size_t>(trial) % open.size()];
    case protocol::Interleave::random:
      break;
  }
  return open[draws(Stream::interleave, trial).below(open.size())];
}

bool Director::State::catch_due() const {
  return now()->catch_trials && draws(Stream::catch_trial, trial).uniform() < now()->catch_trials->rate;
}

TrialSpec Director::State::blank(store::TrialType type, Stream) const {
  TrialSpec spec;
  spec.block_index = static_cast<int>(block);
  spec.attempt = attempt;
  spec.trial_in_block = trial;
  spec.type = now()->practice ? store::TrialType::practice : type;
  spec.factors = drawn_factors();
  spec.deadline_s = deadline();
  spec.timeouts_are_data = timeouts_are_data();
  return spec;
}

/// Everything that follows once level and factors stand: order of intervals, right answer, roving, times.
void Director::State::complete(TrialSpec& spec) const {
  const int key = spec.type == store::TrialType::warmup ? -1 - warmups_given : trial;
  const auto order = order_for(protocol.task, seed, static_cast<int>(block), attempt,
                               spec.type == store::TrialType::warmup ? warmups_given : trial);
  spec.intervals = order.intervals;
  spec.correct = order.correct ? order.correct : correct_choice(protocol.task, spec.factors);
  spec.slider = slider(key);
  auto rove = draws(Stream::roving, key);
  for (const auto& interval : spec.intervals) {
    const double range = protocol.scenes.at(interval.front()).rove_dB;
    spec.rove_dB.push_back(range > 0 ? rove.uniform(-range, range) : 0);
  }
  const auto& iti = protocol.timing.iti_s;
  spec.iti_s = draws(Stream::intertrial, key).uniform(iti.low, iti.high);
  if (const auto& foreperiod = protocol.task.foreperiod_s)
    spec.foreperiod_s = draws(Stream::foreperiod, key).uniform(foreperiod->low, foreperiod->high);
}

/// The window shown is wider than the range by a fifth, split between its ends at random in whole steps.
std::optional<SliderSpan> Director::State::slider(int key) const {
  const auto& task = protocol.task;
  for (const auto& factor : protocol.factors) {
    if (task.kind != protocol::TaskKind::adjustment || factor.name != task.adjusts || !factor.range) continue;
    SliderSpan span;
    span.low = factor.range->first, span.high = factor.range->second;
    span.step = task.step.value_or((span.high - span.low) / 100);
    const auto spare = std::llround(0.2 * (span.high - span.low) / span.step);
    const auto below = draws(Stream::adjustment_start, key).below(static_cast<std::uint64_t>(spare) + 1);
    span.shown_low = span.low - static_cast<double>(below) * span.step;
    span.shown_high = span.high + static_cast<double>(spare - static_cast<long long>(below)) * span.step;
    return span;
  }
  return std::nullopt;
}

TrialSpec Director::State::warmup_trial() const {
  auto spec = blank(store::TrialType::warmup, Stream::warmup);
  spec.type = store::TrialType::warmup;
  std::vector<double> levels = practice_levels;
  std::string factor = now()->level;
  if (!specs.empty()) {
    factor = specs.front()->level;
    levels = specs.front()->values.empty() ? specs.front()->stimuli.values : specs.front()->values;
    if (levels.empty() && specs.front()->start) levels = {*specs.front()->start};
  }
  const auto easy = easy_levels(levels);
  if (!easy.empty()) {
    auto draw = draws(Stream::warmup, warmups_given);
    spec.level = easy[draw.below(easy.size())];
    spec.factors[factor] = *spec.level;
  }
  complete(spec);
  return spec;
}

TrialSpec Director::State::catch_trial() const {
  auto spec = blank(store::TrialType::catch_trial, Stream::catch_trial);
  const auto& wanted = *now()->catch_trials;
  auto draw = draws(Stream::catch_trial, trial);
  draw.uniform();  // the one that decided that this is a catch trial
  spec.level = wanted.levels[draw.below(wanted.levels.size())];
  spec.factors[wanted.factor] = *spec.level;
  complete(spec);
  return spec;
}

std::optional<TrialSpec> Director::State::practice_trial() const {
  if (static_cast<std::size_t>(trial) >= practice_levels.size()) return std::nullopt;
  auto spec = blank(store::TrialType::experimental, Stream::practice);
  spec.level = practice_levels[static_cast<std::size_t>(trial)];
  spec.factors[now()->level] = *spec.level;
  complete(spec);
  return spec;
}

TrialSpec Director::State::procedure_trial(int index) const {
  const auto& from = *specs[static_cast<std::size_t>(index)];
  const auto proposal = procedures[static_cast<std::size_t>(index)]->next();
  auto spec = blank(store::TrialType::experimental, Stream::level_order);
  spec.procedure = from.name;
  spec.level = proposal->level;
  spec.factors[from.level] = proposal->level;
  for (const auto& [name, level] : proposal->balanced)
    for (const auto& factor : protocol.factors)
      if (factor.name == name) spec.factors[name] = factor.levels.at(level);
  complete(spec);
  return spec;
}

std::optional<TrialSpec> Director::State::make() {
  if (now() == nullptr) return std::nullopt;
  current_procedure = kNoProcedure;
  if (warmups > 0) return warmup_trial();
  if (!practice_levels.empty()) return practice_trial();
  if (now()->trials && shown >= *now()->trials) return std::nullopt;
  const auto index = pick_procedure();
  if (!index) return std::nullopt;
  if (catch_due()) return catch_trial();
  current_procedure = *index;
  return procedure_trial(*index);
}

void Director::State::learn(const TrialEnd& end) {
  if (current_procedure == kNoProcedure) return;
  const auto index = static_cast<std::size_t>(current_procedure);
  if (specs[index]->kind == procedure::Kind::adjustment && end.setting &&
      end.outcome == store::TrialOutcome::answered)
    return procedures[index]->record_setting(*end.setting);
  auto answer = procedure::Answer::none;
  if (end.outcome == store::TrialOutcome::answered && end.response) {
    const auto& tracks = specs[index]->tracks;
    const auto& choice = protocol.task.choices[static_cast<std::size_t>(*end.response)];
    const bool one = tracks.empty() ? end.correct.value_or(false) : choice.id == tracks;
    answer = one ? procedure::Answer::one : procedure::Answer::zero;
  }
  procedures[index]->record(answer);
}

int Director::State::block_expected(const Block& b) const {
  if (!b.levels.empty()) return b.trials.value_or(static_cast<int>(b.levels.size()));
  if (b.trials) return *b.trials;
  double trials = 0;
  for (const auto& name : b.procedures) {
    const auto& spec = *find_spec(name);
    if (spec.kind == procedure::Kind::constant_stimuli || spec.kind == procedure::Kind::adjustment)
      trials += static_cast<double>(spec.values.size()) * spec.repeats;
    else
      trials += spec.stop.trials.value_or(6 * spec.stop.reversals.value_or(8));
  }
  return static_cast<int>(std::lround(trials * (1 + (b.catch_trials ? b.catch_trials->rate : 0))));
}

Director::Director(const protocol::Protocol& protocol, int sequence_index, std::uint64_t seed)
    : state_(std::make_unique<State>(protocol, sequence_index, seed)) {}
Director::~Director() = default;
Director::Director(Director&&) noexcept = default;

const Block* Director::block() const { return state_->now(); }
int Director::block_index() const { return static_cast<int>(state_->block); }
int Director::attempt() const { return state_->attempt; }
int Director::blocks() const { return static_cast<int>(state_->blocks.size()); }

std::optional<TrialSpec> Director::next() {
  if (!state_->current) state_->current = state_->make();
  return state_->current;
}

void Director::record(const TrialEnd& end) {
  auto& s = *state_;
  if (!s.current) throw std::logic_error("director: nothing was given that could have ended");
  if (end.outcome == store::TrialOutcome::fault || end.outcome == store::TrialOutcome::aborted) return;
  const auto type = s.current->type;
  s.current.reset();
  if (type == store::TrialType::warmup) {
    --s.warmups, ++s.warmups_given;
    return;
  }
  s.learn(end);
  ++s.trial, ++s.done;
  if (type != store::TrialType::catch_trial) ++s.shown;
  if (end.correct.value_or(false)) ++s.right;
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
    s.expected_before += s.trial - s.block_expected(*b);
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
  state_->warmups = trials;
  state_->current.reset();
}

const std::string& Director::ended_because() const { return state_->ended; }
int Director::trials_done() const { return state_->done; }

int Director::trials_expected() const {
  int sum = state_->expected_before;
  for (const auto& block : state_->blocks) sum += state_->block_expected(block);
  return std::max(sum, state_->done);
}

std::vector<ProcedureEstimate> Director::estimates() const {
  std::vector<ProcedureEstimate> all;
  for (std::size_t i = 0; i < state_->procedures.size(); ++i)
    for (const auto& [parameter, e] : state_->procedures[i]->estimates())
      all.push_back({state_->specs[i]->name, parameter, e.mean, e.sd});
  return all;
}

std::optional<std::pair<double, double>> Director::threshold() const {
  if (state_->current_procedure == kNoProcedure) return std::nullopt;
  const auto estimates = state_->procedures[static_cast<std::size_t>(state_->current_procedure)]->estimates();
  auto found = estimates.find("threshold");
  if (found == estimates.end()) found = estimates.find("pse");
  if (found == estimates.end()) return std::nullopt;
  return std::pair(found->second.mean, found->second.sd);
}

std::uint64_t Director::state_hash() const {
  procedure::StateHash hash;
  for (const int word :
       {static_cast<int>(state_->block), state_->attempt, state_->trial, state_->right, state_->done})
    hash.add(static_cast<std::uint64_t>(word));
  for (const auto& p : state_->procedures) hash.add(p->state_hash());
  // 63 bits: SQLite's integers are signed.
  return hash.value() >> 1;
}

}  // namespace turnpoint::session

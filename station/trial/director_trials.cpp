#include <algorithm>
#include <cmath>

#include "station/protocol/answers.hpp"
#include "station/protocol/tasks.hpp"
#include "station/trial/director_state.hpp"
#include "station/trial/orders.hpp"

namespace turnpoint::trial {

using core::Stream;

namespace {

/// In a block of strokes: longest time from the end of a stimulus until the measured movement of the finger
/// is known.
constexpr double kMeasured_s = 5;

/// Returns the easiest levels, for warm-up: the highest level or, if there are levels on both sides of zero,
/// the lowest and the highest. Each warm-up trial draws one of them at random.
std::vector<double> easy_levels(const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (values.empty()) return {};
  return *low < 0 && *high > 0 ? std::vector<double>{*low, *high} : std::vector<double>{*high};
}

}  // namespace

bool Director::State::timeouts_are_data() const {
  return protocol::deadline_of_instruction(protocol, *now()) != nullptr;
}

/// Sets the times that depend on the trial's factors.
void Director::State::set_times(TrialSpec& spec) const {
  const auto& timing = protocol.timing;
  const auto set = [&](const protocol::Linear& expression) {
    return protocol::evaluate(expression, spec.factors);
  };
  spec.anticipation_s = set(timing.anticipation_s);
  if (timing.signal) {
    spec.signal_s = spec.anticipation_s = set(timing.signal->after_s);
    spec.deadline_s = *spec.signal_s + timing.signal->window_s;
  } else if (spec.timeouts_are_data) {
    spec.deadline_s = set(*protocol::deadline_of_instruction(protocol, *now()));
  } else if (timing.deadline_s) {
    spec.deadline_s = set(*timing.deadline_s);
  }
}

/// Draws levels for the factors that nothing else sets. A factor that is fixed for the block keeps its value.
protocol::Factors Director::State::drawn_factors() const {
  auto factors = now()->fixed;
  // Draws that were given up, because they would make a run too long, are skipped.
  auto draw = draws(Stream::factor_level, trial);
  for (int skipped = 0; skipped < deviation.redraws; ++skipped) draw.uniform();
  for (std::size_t i = 0; i < protocol.factors.size(); ++i) {
    const auto& factor = protocol.factors[i];
    if (factors.count(factor.name)) continue;
    if (factor.draw != protocol::FactorDraw::levels)
      factors[factor.name] = drawn_value(factor, static_cast<int>(i));
    else if (!factor.levels.empty())
      factors[factor.name] = factor.levels[draw.below(factor.levels.size())];
  }
  return factors;
}

/// Draws the value of the factor with this number for the current trial.
protocol::FactorValue Director::State::drawn_value(const protocol::Factor& factor, int number) const {
  constexpr int most_factors = 100;
  const auto key = [&](int of) { return of * most_factors + number; };
  if (factor.draw == protocol::FactorDraw::without_repetition) {
    const auto count = static_cast<int>(factor.levels.size());
    auto levels = factor.levels;
    draws(Stream::factor_list, key(trial / count)).shuffle(levels);
    return levels[static_cast<std::size_t>(trial % count)];
  }
  const auto [low, high] = *factor.range;
  auto draw = draws(Stream::factor_value, key(trial));
  for (int skipped = 0; skipped < deviation.redraws; ++skipped) draw.uniform();
  if (factor.draw == protocol::FactorDraw::uniform) return draw.uniform(low, high);
  for (;;) {
    const double value = factor.mean + factor.sd * draw.normal();
    if (value >= low && value <= high) return value;
  }
}

std::optional<int> Director::State::pick_procedure() {
  std::vector<int> open;
  for (std::size_t i = 0; i < procedures.size(); ++i)
    if (procedures[i]->next()) open.push_back(static_cast<int>(i));
  if (open.empty()) return std::nullopt;
  const auto is_open = [&open](int index) { return std::ranges::find(open, index) != open.end(); };
  switch (now()->interleave) {
    case protocol::Interleave::none:
      return open.front();
    case protocol::Interleave::alternate: {
      // Catch trials do not take a turn.
      const auto next = std::ranges::find_if(open, [this](int index) { return index > last_procedure; });
      return next == open.end() ? open.front() : *next;
    }
    case protocol::Interleave::passes:
      std::erase_if(pass, [&](int index) { return !is_open(index); });
      if (pass.empty()) {
        pass = open;
        draws(Stream::interleave, shown).shuffle(pass);
      }
      return pass.front();
    case protocol::Interleave::random:
      break;
  }
  return open[draws(Stream::interleave, trial).below(open.size())];
}

bool Director::State::catch_due() const {
  return now()->catch_trials && draws(Stream::catch_trial, trial).uniform() < now()->catch_trials->rate;
}

TrialSpec Director::State::blank(core::TrialType type) const {
  TrialSpec spec;
  spec.block_index = static_cast<int>(block);
  spec.attempt = attempt;
  spec.trial_in_block = trial;
  spec.task = block_task;
  spec.type = now()->practice ? core::TrialType::practice : type;
  spec.factors = drawn_factors();
  spec.timeouts_are_data = timeouts_are_data();
  return spec;
}

const IntervalOrder& Director::State::presented_order(int key) const {
  return order_for(orders(), seed, static_cast<int>(block), attempt, key);
}

/// The number by which order_for() finds the trial's order of intervals. In a block of several tasks, each
/// counts its own trials, so that its orders come equally often, and has orders of its own: those of one task
/// must not tell those of another.
int Director::State::order_number(const TrialSpec& spec) const {
  if (spec.type == core::TrialType::warmup) return warmups_given;
  if (protocol::tasks_in(protocol, *now()).size() < 2) return order_key(deviation.order_of.value_or(trial));
  const int apart = 1'000'000 * run_of_orders();
  return static_cast<int>(spec.task) * apart + task_trials[spec.task];
}

/// True if the next trial is the first one of its task in the block or after a rest, and a part is then
/// longer.
bool Director::State::is_fresh(std::size_t task) const {
  if (adapted.contains(task)) return false;
  const auto parts = protocol::parts_of(seen_by(task).task);
  return std::any_of(parts.begin(), parts.end(), [](const auto& part) { return part.first_s; });
}

/// Fills in what follows from the level and the factors: order of intervals, right answer, roving, times.
void Director::State::complete(TrialSpec& spec) const {
  const int key = spec.type == core::TrialType::warmup ? -1 - warmups_given : trial;
  const auto& task = seen_by(spec.task).task;
  const auto& order =
      order_for(orders_by_task[spec.task], seed, static_cast<int>(block), attempt, order_number(spec));
  spec.intervals = order.intervals;
  spec.correct = order.correct ? order.correct : correct_choice(task, spec.factors, order.intervals);
  spec.slider = slider(spec.task, key);
  spec.fresh = is_fresh(spec.task);
  auto rove = draws(Stream::roving, key);
  std::vector<std::vector<protocol::Part>> lists;
  if (!task.before.empty()) lists.push_back(task.before);
  for (const auto& interval : spec.intervals) lists.push_back(protocol::parts_of(task, interval));
  for (const auto& parts : lists) {
    const auto range = [&](const protocol::Part& part) {
      return protocol.scenes.at(part.scenes.front()).rove_dB;
    };
    double widest = 0;
    for (const auto& part : parts) widest = std::max(widest, range(part));
    const double drawn = widest > 0 ? rove.uniform(-widest, widest) : 0;
    for (const auto& part : parts)
      spec.rove_dB.push_back(range(part) == widest ? drawn : drawn * range(part) / widest);
  }
  set_times(spec);
  const auto time_s = [&](const protocol::Distribution& from, Stream stream) {
    return from.expression ? protocol::evaluate(*from.expression, spec.factors)
                           : draws(stream, key).uniform(from.low, from.high);
  };
  spec.iti_s = time_s(protocol.timing.iti_s, Stream::intertrial);
  if (const auto& foreperiod = task.foreperiod_s) spec.foreperiod_s = time_s(*foreperiod, Stream::foreperiod);
}

/// Returns the window that the slider shows. It is a fifth wider than the factor's range. This surplus is
/// divided between the two ends at random, in whole steps.
std::optional<SliderSpan> Director::State::slider(std::size_t of_task, int key) const {
  const auto& task = seen_by(of_task).task;
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
  auto spec = blank(core::TrialType::warmup);
  spec.type = core::TrialType::warmup;
  std::vector<double> levels = practice_levels;
  std::string factor = now()->level;
  if (!specs.empty()) {
    factor = specs.front()->level;
    for (const auto& [name, value] : specs.front()->with) spec.factors[name] = value;
    // any stimuli will do, also equal ones
    for (std::size_t i = 0; i < specs.front()->against.size(); ++i)
      spec.factors[specs.front()->against[i]] = specs.front()->values[i];
    if (const auto& second = specs.front()->second)
      spec.factors[second->level] = second->stimuli.values[second->stimuli.values.size() / 2];
    levels = specs.front()->values.empty() ? specs.front()->stimuli.values : specs.front()->values;
    if (levels.empty() && specs.front()->start) levels = {*specs.front()->start};
    if (levels.empty() && specs.front()->min && specs.front()->max)
      levels = {*specs.front()->min, *specs.front()->max};
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
  auto spec = blank(core::TrialType::catch_trial);
  const auto& wanted = *now()->catch_trials;
  auto draw = draws(Stream::catch_trial, trial);
  draw.uniform();  // skip the random number that has decided that this is a catch trial
  for (int skipped = 0; skipped < deviation.redraws; ++skipped) draw.uniform();
  spec.level = wanted.levels[draw.below(wanted.levels.size())];
  spec.factors[wanted.factor] = *spec.level;
  complete(spec);
  return spec;
}

std::optional<TrialSpec> Director::State::practice_trial() const {
  if (static_cast<std::size_t>(trial) >= practice_levels.size()) return std::nullopt;
  auto spec = blank(core::TrialType::experimental);
  spec.level = practice_levels[static_cast<std::size_t>(trial)];
  spec.factors[now()->level] = *spec.level;
  complete(spec);
  return spec;
}

/// Returns a trial of a block of strokes. In a training block, the "right" answer is a movement within the
/// limits of [sensing].
std::optional<TrialSpec> Director::State::strokes_trial() const {
  if (static_cast<std::size_t>(trial) >= practice_levels.size()) return std::nullopt;
  const bool training = now()->kind == protocol::BlockKind::training;
  auto spec = blank(core::TrialType::practice);
  spec.level = practice_levels[static_cast<std::size_t>(trial)];
  spec.intervals = {{now()->strokes.scene}};
  spec.rove_dB = {0};
  spec.strokes = now()->strokes;
  spec.deadline_s = kMeasured_s;
  spec.timeouts_are_data = false;
  if (training) spec.correct = 0;
  const auto& iti =
      protocol.timing.iti_s;  // such a trial has no factors: of an expression, any value will do
  spec.iti_s = draws(Stream::intertrial, trial).uniform(iti.low, iti.high);
  return spec;
}

void Director::State::set_proposal(const procedure::Proposal& proposal, const procedure::Spec& from,
                                   protocol::Factors& factors) const {
  factors[from.level] = proposal.level;
  if (proposal.second) factors[from.second->level] = *proposal.second;
  for (std::size_t i = 0; i < proposal.against.size(); ++i) factors[from.against[i]] = proposal.against[i];
  for (const auto& [name, value] : from.with) factors[name] = value;
  for (const auto& [name, level] : proposal.balanced)
    for (const auto& factor : protocol.factors)
      if (factor.name == name) factors[name] = factor.levels.at(level);
}

TrialSpec Director::State::procedure_trial(int index) const {
  const auto& from = *specs[static_cast<std::size_t>(index)];
  const auto proposal = procedures[static_cast<std::size_t>(index)]->choice(deviation.place);
  auto spec = blank(core::TrialType::experimental);
  spec.procedure = from.name;
  spec.task = protocol::task_of(protocol, from.name, "");
  spec.level = proposal.level;
  set_proposal(proposal, from, spec.factors);
  complete(spec);
  return spec;
}

std::optional<TrialSpec> Director::State::make() {
  deviation = {};
  left_of_lists.clear();
  if (now() == nullptr) return std::nullopt;
  current_procedure = no_procedure;
  if (now()->kind != protocol::BlockKind::trials) return strokes_trial();
  if (time_is_up()) return std::nullopt;
  if (warmups > 0) return warmup_trial();
  if (!practice_levels.empty()) return practice_trial();
  if (now()->trials && shown >= *now()->trials) return std::nullopt;
  const auto index = pick_procedure();
  if (!index) return std::nullopt;
  const bool due = catch_due();
  if (due && runs.empty()) return catch_trial();
  if (due || catches_owed > 0) {
    // A catch trial that would make a run too long is put off.
    auto spec = with_short_runs(catch_trial());
    if (spec) deviation.catches = due ? 0 : -1;
    if (spec) return spec;
  }
  current_procedure = *index;
  auto spec = procedure_trial(*index);
  if (!runs.empty()) spec = with_short_runs(spec).value();
  deviation.catches = due ? 1 : 0;
  return spec;
}

}  // namespace turnpoint::trial

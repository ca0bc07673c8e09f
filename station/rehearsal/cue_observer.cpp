#include "station/rehearsal/cue_observer.hpp"

#include <algorithm>
#include <cmath>

#include "station/core/draws.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/combinations.hpp"
#include "station/trial/orders.hpp"

namespace turnpoint::rehearsal {

using protocol::TaskKind;
using trial::TrialSpec;

namespace {

// Required precision (three standard errors) of an observer's accuracy in simulated sessions. The first
// sessions show how many sessions are needed for this precision; there are at most `most_sessions`.
constexpr double precision = 0.01;
constexpr int first_sessions = 30, most_sessions = 1000;
// Where the answers decide how often each answer is right, sessions differ more from each other.
constexpr int most_sessions_of_one_interval = 6000;

// True if chance has a part in which levels come, even if it has none in the answers.
bool chance_sets_levels(const protocol::Protocol& protocol) {
  using procedure::Kind;
  const auto draws = [](const procedure::Spec& spec) {
    return spec.kind == Kind::constant_stimuli || spec.kind == Kind::limits || spec.kind == Kind::program;
  };
  const auto cuts = [](const auto& part) {
    const auto* sequence = std::get_if<protocol::Sequence>(&part);
    const auto& block = sequence ? sequence->block : std::get<protocol::Block>(part);
    return block.trials && block.procedures.size() > 1;
  };
  return std::any_of(protocol.procedures.begin(), protocol.procedures.end(), draws) ||
         std::any_of(protocol.plan.begin(), protocol.plan.end(), cuts);
}

// True if each of these trials gets the same answer for certain.
bool answers_alike(const Rule& rule, const Asked& asked, const std::vector<Look>& looks) {
  return std::all_of(looks.begin(), looks.end(), [&](const Look& look) {
    const auto here = shares(rule, asked, look.x);
    return here == shares(rule, asked, looks.front().x) && std::count(here.begin(), here.end(), 1.0) == 1;
  });
}

}  // namespace

Interval CueObserver::interval_of(const std::vector<std::string>& scenes, const protocol::Factors& factors) {
  const auto cues = [&](const std::string& scene) {
    const auto found = table_.find(scene, factors);
    if (!found) throw NotPlanned("scene \"" + scene + "\" at " + protocol::format(factors));
    return *found;
  };
  const auto parts = protocol::parts_of(protocol_.task, scenes);
  Interval interval;
  for (const auto& part : parts) {
    double silence_s = 0;
    for (const auto& silence : part.silences_s) silence_s += protocol::evaluate(silence, factors);
    const auto* length = protocol::length_of(protocol_.task, part);
    const double length_s =
        length ? protocol::evaluate(*length, factors) : protocol_.timing.explore_s.value_or(0);
    interval.duration_s += silence_s + length_s;
    if (!interval.lengths_s.empty()) interval.lengths_s.push_back(silence_s);  // before a second part
    if (parts.size() > 1) interval.lengths_s.push_back(length_s);
    // A change under the finger whose time depends on factors divides the interval in two.
    if (const auto& foreperiod = protocol_.task.foreperiod_s;
        part.scenes.size() > 1 && foreperiod && foreperiod->expression) {
      const double before_s = protocol::evaluate(*foreperiod->expression, factors);
      interval.lengths_s.insert(interval.lengths_s.end(), {before_s, length_s - before_s});
    }
    for (const auto& scene : part.scenes) {
      interval.scenes.push_back(cues(scene));
      interval.rove_dB.push_back(protocol_.scenes.at(part.scenes.front()).rove_dB);
    }
  }
  interval.duration_s -= 1e-3 * protocol_.scenes.at(parts.front().scenes.front()).ramp_ms;
  return interval;
}

const std::vector<Interval>& CueObserver::intervals_of(const TrialSpec& trial) {
  auto& intervals = intervals_[{trial.intervals, trial.factors}];
  if (intervals.empty())
    for (const auto& scenes : trial.intervals) intervals.push_back(interval_of(scenes, trial.factors));
  return intervals;
}

const std::vector<Presentation>& CueObserver::presentations(const protocol::Factors& cell,
                                                            const TrialCensus& census) {
  const auto [found, is_new] = presentations_.try_emplace(cell);
  auto& all = found->second;
  if (!is_new) return all;
  const auto orders = trial::orders_of(protocol_.task);
  const auto combinations = census.combinations(cell);
  for (const auto& factors : combinations)
    for (const auto& order : orders) {
      const auto correct =
          order.correct ? order.correct : trial::correct_choice(protocol_.task, factors, order.intervals);
      if (!correct) continue;  // no answer to this trial is right, so the trial does not count
      turn_ += 0.7548776662466927;
      Presentation presentation;
      presentation.correct = *correct, presentation.turn = turn_;
      presentation.share = 1.0 / static_cast<double>(orders.size() * combinations.size());
      for (const auto& scenes : order.intervals)
        presentation.intervals.push_back(interval_of(scenes, factors));
      all.push_back(std::move(presentation));
    }
  return all;
}

Cells CueObserver::cells_of(const TrialCensus& census) {
  Cells cells;
  for (const auto& [cell, trials] : census.cells()) cells.emplace_back(&presentations(cell, census), trials);
  return cells;
}

// Roving varies the strength of stimuli at random, with a uniform distribution. Here a low-discrepancy
// sequence (Roberts 2018), with one dimension per interval, replaces the random draws, because fewer points
// are then enough.
std::vector<Look> CueObserver::looks(const CueKind& kind, Feature feature, const Cells& cells,
                                     Draws draws) const {
  const double g = asked_.intervals > 3 ? 1.1673039782614187 : 1.2207440846057596;
  const double steps[] = {1 / g, 1 / (g * g), 1 / (g * g * g), 1 / (g * g * g * g)};
  const auto moves = [&](const Interval& interval) { return roves(kind, interval); };
  std::vector<Look> looks;
  for (const auto& [presentations, trials] : cells)
    for (const auto& presentation : *presentations) {
      const auto& intervals = presentation.intervals;
      const int points = std::any_of(intervals.begin(), intervals.end(), moves) ? points_ : 1;
      const int begin = draws == Draws::to_choose ? 1 : points + 1;
      for (int k = begin; k < begin + points; ++k) {
        Look look;
        look.correct = presentation.correct, look.weight = trials * presentation.share / points;
        for (std::size_t i = 0; i < intervals.size(); ++i) {
          const double u = points == 1 ? 0.5 : std::fmod(presentation.turn + k * steps[i], 1.0);
          look.x[i] = value_of(kind, intervals[i], feature, 2 * u - 1);
        }
        looks.push_back(look);
      }
    }
  return looks;
}

Strategy CueObserver::best_strategy(const CueKind& kind, const Grain& grain, const Cells& all) const {
  Strategy best;
  double most = -1;
  for (const auto feature : features_of(kind)) {
    const auto looked = looks(kind, feature, all, Draws::to_choose);
    // a difference of two scenes can be 0 but for rounding errors, so a share of it means nothing
    const Grain own = feature == Feature::change ? Grain{grain.absolute, 0} : grain;
    const Strategy strategy{feature, best_rule(asked_, looked, own)};
    const double right = accuracy(strategy.rule, asked_, looked);
    if (right > most) most = right, best = strategy;
  }
  return best;
}

Score CueObserver::score(const CueKind& kind, const Strategy& strategy, const Cells& cells) const {
  return score(strategy, looks(kind, strategy.feature, cells, Draws::to_judge));
}

Score CueObserver::score(const Strategy& strategy, const std::vector<Look>& looks) const {
  Score score;
  for (const auto& look : looks) {
    const auto correct = static_cast<std::size_t>(look.correct);
    score.trials += look.weight, score.keys[correct] += look.weight;
    score.right += look.weight * shares(strategy.rule, asked_, look.x)[correct];
  }
  return score;
}

int CueObserver::answer(const CueKind& kind, const Strategy& strategy, const TrialSpec& trial,
                        std::uint64_t seed) {
  const auto& intervals = intervals_of(trial);
  CueValues x{};
  std::size_t next = protocol_.task.before.size();  // the part with which the interval begins
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    double share = 0;
    for (const auto& part : protocol::parts_of(protocol_.task, trial.intervals[i])) {
      const double range_dB = protocol_.scenes.at(part.scenes.front()).rove_dB;
      if (range_dB > 0) share = trial.rove_dB.at(next) / range_dB;
      ++next;
    }
    x[i] = value_of(kind, intervals[i], strategy.feature, share);
  }
  const auto answers = shares(strategy.rule, asked_, x);
  core::Draws draws({seed, core::Stream::observer, trial.block_index, trial.attempt, trial.trial_in_block});
  double left = draws.uniform();
  int choice = 0;
  while (choice + 1 < static_cast<int>(asked_.answers) && left >= answers[static_cast<std::size_t>(choice)])
    left -= answers[static_cast<std::size_t>(choice++)];
  return choice;
}

std::vector<Shares> CueObserver::answers_to(const Cells& cells, const CueKind& kind,
                                            const Strategy& strategy) const {
  std::vector<Shares> answers;
  for (const auto& look : looks(kind, strategy.feature, cells, Draws::to_judge))
    answers.push_back(shares(strategy.rule, asked_, look.x));
  return answers;
}

// Returns what the observer sees in one kind of trial.
const std::vector<Look>& CueObserver::looks_in(const CueKind& kind, Feature feature,
                                               const std::vector<Presentation>& presentations) {
  if (looked_at_ != &kind) looks_.clear();
  looked_at_ = &kind;
  const auto [found, is_new] = looks_.try_emplace({feature, &presentations});
  if (is_new) found->second = looks(kind, feature, {{&presentations, 1.0}}, Draws::to_judge);
  return found->second;
}

// If chance has no part in the answers and none in the levels, all sessions are alike. The second one is
// there to be sure.
void CueObserver::run_sessions(const CueKind& kind, const Strategy& strategy, int count, OwnSessions& own,
                               std::uint64_t first_seed) {
  const bool by_chance = chance_sets_levels(protocol_);
  const auto all_alike = [&] {
    return own.certain && !by_chance && own.done.size() == 2 && own.done[0] == own.done[1];
  };
  while (static_cast<int>(own.done.size()) < count && !all_alike()) {
    if (stop_.stop_requested()) throw protocol::Abandoned();
    if (steps_.finish.stop_requested()) throw Finished();
    const auto seed = first_seed + own.done.size();
    const auto census = census_of_session(
        protocol_, seed, [&](const TrialSpec& trial) { return answer(kind, strategy, trial, seed); });
    Score sum;
    for (const auto& [presentations, trials] : cells_of(census)) {
      const auto [found, is_new] = own.scores.try_emplace(presentations);
      if (is_new) {
        const auto& seen = looks_in(kind, strategy.feature, *presentations);
        found->second = score(strategy, seen);
        own.certain = own.certain && answers_alike(strategy.rule, asked_, seen);
      }
      sum.add(found->second, trials);
    }
    own.done.push_back(sum);
  }
}

// Returns the lowest and the highest accuracy of a strategy over the kinds of trials.
std::pair<double, double> CueObserver::accuracies(const CueKind& kind, const Strategy& strategy,
                                                  const Cells& all) const {
  double low = 1, high = 0;
  for (const auto& cell : all) {
    const auto here = score(kind, strategy, {cell});
    if (here.trials == 0) continue;
    low = std::min(low, here.accuracy()), high = std::max(high, here.accuracy());
  }
  return {low, high};
}

// Only the first sessions determine the number of sessions. If later results influenced that number, the
// accuracy would be biased.
const OwnSessions& CueObserver::own_sessions(const CueKind& kind, const Strategy& strategy) {
  for (const auto& known : own_sessions_)
    if (answers_to(known.visited, kind, strategy) == known.answers) return known;
  OwnSessions own;
  run_sessions(kind, strategy, first_sessions, own, 0);
  const double error = 3 * standard_error(own.done) / precision;
  const int most =
      protocol_.task.kind == TaskKind::single_interval ? most_sessions_of_one_interval : most_sessions;
  run_sessions(kind, strategy, static_cast<int>(std::min<double>(most, first_sessions * error * error)), own,
               0);
  own.sum = sum_of(own.done), own.error = 3 * standard_error(own.done);
  for (const auto& [presentations, unused] : own.scores) own.visited.emplace_back(presentations, 1.0);
  own.answers = answers_to(own.visited, kind, strategy);
  return own_sessions_.emplace_back(std::move(own));
}

// A rule that is equally good at every level needs no simulated sessions: whichever levels its answers lead
// to, the accuracy is the same. With one interval the levels also decide how often each key is right.
Reached CueObserver::by_itself(const CueKind& kind, const Strategy& strategy, const Cells& all) {
  if (protocol_.task.kind != TaskKind::single_interval)
    if (const auto [low, high] = accuracies(kind, strategy, all); high - low <= 2 * precision) {
      const double by_guessing = chance(score(kind, strategy, all));
      return {std::max(0.5 * (low + high), by_guessing), by_guessing, 0.5 * (high - low)};
    }
  const auto& own = own_sessions(kind, strategy);
  return {std::max(own.sum.accuracy(), chance(own.sum)), chance(own.sum), own.error};
}

std::vector<Feature> CueObserver::features_of(const CueKind& kind) const {
  const auto& task = protocol_.task;
  std::size_t most = 0;  // number of parts of an interval
  for (const auto& [name, parts] : task.parts) most = std::max(most, parts.size());
  if (most > 1 && kind.source != Source::nothing) {
    std::vector<Feature> features{Feature::last};
    if (kind.source == Source::surface) features.push_back(Feature::change);
    const auto ones = kind.source == Source::surface ? most : 2 * most - 1;
    for (std::size_t i = 0; i < ones; ++i) features.push_back(feature_of_one(i));
    return features;
  }
  if (kind.source == Source::duration && task.foreperiod_s && task.foreperiod_s->expression)
    return {Feature::last, feature_of_one(0), feature_of_one(1)};
  const bool change = kind.source == Source::surface && task.kind == TaskKind::single_interval &&
                      task.intervals.front().size() > 1;
  if (change) return {Feature::last, Feature::change, Feature::first};
  return {Feature::last};
}

// The accuracy of an observer who always presses this key, in the sessions to which this leads.
Reached CueObserver::by_key(const CueKind& kind, int key, const Cells& all) {
  const Strategy strategy{Feature::last, always(key)};
  const auto [low, high] = accuracies(kind, strategy, all);
  if (!levels_follow_answers(protocol_) || high - low <= 2 * precision)
    return {score(kind, strategy, all).accuracy(), guessing(), 0};
  const auto& own = own_sessions(kind, strategy);
  return {own.sum.accuracy(), guessing(), own.error};
}

}  // namespace turnpoint::rehearsal

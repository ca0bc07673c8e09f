#include "station/simulation/cue_guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "station/protocol/answers.hpp"
#include "station/protocol/combinations.hpp"
#include "station/random/draws.hpp"
#include "station/simulation/cue_score.hpp"
#include "station/simulation/cue_table.hpp"
#include "station/simulation/one_cue.hpp"
#include "station/simulation/trial_census.hpp"
#include "station/trial/orders.hpp"

namespace turnpoint::simulation {

namespace {

using protocol::Protocol;
using protocol::TaskKind;
using trial::TrialSpec;

enum class Source { surface, duration, nothing };

struct CueKind {
  const char* name;
  const char* unit;
  double scale;
  Source source;
  double scene::Cues::*cue;
  bool follows_strength;  ///< true if roving the strength always changes this cue
};

constexpr CueKind cue_kinds[] = {
    {"pitch", "Hz", 1, Source::surface, &scene::Cues::pitch_Hz, false},
    {"loudness", "dB", 1, Source::surface, &scene::Cues::loudness_dB, true},
    {"amplitude at the wide end", "um", 1e6, Source::surface, &scene::Cues::wide_end_amplitude_m, true},
    {"stripe pitch at the wide end", "mm", 1e3, Source::surface, &scene::Cues::stripe_pitch_m, false},
    {"edge sharpness", "mm", 1e3, Source::surface, &scene::Cues::edge_width_m, false},
    {"strip width", "mm", 1e3, Source::surface, &scene::Cues::strip_width_m, false},
    {"duration", "s", 1, Source::duration, nullptr, false},
    {"always the same key", "", 1, Source::nothing, nullptr, false},
};

constexpr double smallest_difference = 1e-3, smallest_difference_dB = 0.01;

// Required precision (three standard errors) of an observer's accuracy in simulated sessions. The first
// sessions show how many sessions are needed for this precision; there are at most `most_sessions`.
constexpr double precision = 0.01;
constexpr int first_sessions = 30, most_sessions = 1000;

/// Thrown if the cues of some trials can neither be planned nor interpolated.
struct NotPlanned : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Thrown when the caller asks to end the comparison early and to report what has been compared so far.
struct Finished {};

/// The cues (pitch, loudness, ...) of one interval's first and last scene, for any strength that roving may
/// draw.
struct Interval {
  RovedCues first, last;
  double duration_s = 0;
};

struct Presentation {
  std::vector<Interval> intervals;
  int correct = 0;
  /// probability that a trial of this kind (cell) has this order of intervals and this combination of factors
  double share = 0;
  double turn = 0.5;  ///< offset into the sequence of quasi-random strengths (see looks())
};

/// All cells (kinds of trial) of the census, each with its possible presentations and its number of trials.
using Cells = std::vector<std::pair<const std::vector<Presentation>*, double>>;

/// Which value of a cue (pitch, loudness, ...) the observer uses in an interval that changes from one scene
/// to another.
enum class Feature { last, change, first };

/// Strengths are drawn in two equally large sets for each trial. The first set chooses the rule and the
/// second measures its accuracy, because any rule looks too good on the draws for which it was chosen.
enum class Draws { to_choose, to_judge };

struct Strategy {
  Feature feature = Feature::last;
  Rule rule;
};

/// Simulated sessions in which the observer's answers determine the next level. Two cues that give the same
/// answers in all presented trials lead to the same sessions, so the second cue reuses the sessions of the
/// first.
struct OwnSessions {
  std::vector<Score> done;
  /// for each kind of trial (cell) that occurred: the expected score of one trial
  std::map<const std::vector<Presentation>*, Score> scores;
  Cells visited;
  std::vector<Shares> answers;  ///< the observer's answers in each kind of trial (cell) of `visited`
  Reached reached;
};

double number_of(const CueKind& kind, const Interval& interval, Feature feature, double rove_dB) {
  if (kind.source == Source::nothing) return 0;
  if (kind.source == Source::duration) return interval.duration_s;
  if (feature == Feature::first) return interval.first.at(rove_dB).*kind.cue;
  const double last = interval.last.at(rove_dB).*kind.cue;
  return feature == Feature::last ? last : last - interval.first.at(rove_dB).*kind.cue;
}

std::pair<double, double> range_of(const std::vector<Look>& looks, std::size_t intervals) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const auto& look : looks)
    for (std::size_t i = 0; i < intervals; ++i)
      low = std::min(low, look.x[i]), high = std::max(high, look.x[i]);
  return {low, high};
}

class Guard {
 public:
  Guard(const Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey,
        const std::stop_token& stop, const Steps& steps)
      : protocol_(protocol),
        stop_(stop),
        steps_(steps),
        asked_(asked_by(protocol.task)),
        table_(protocol, rig, survey) {}

  void add_reports(CueGuard& guard);

 private:
  Interval interval_of(const std::vector<std::string>& scenes, const protocol::Factors& factors);
  const std::vector<Interval>& intervals_of(const TrialSpec& trial);
  const std::vector<Presentation>& presentations(const protocol::Factors& cell, const TrialCensus& census);
  Cells cells_of(const TrialCensus& census);
  std::vector<Look> looks(const CueKind& kind, Feature feature, const Cells& cells, Draws draws) const;
  Score score(const CueKind& kind, const Strategy& strategy, const Cells& cells) const;
  int answer(const CueKind& kind, const Strategy& strategy, const TrialSpec& trial, std::uint64_t seed);
  std::vector<Shares> answers_to(const Cells& cells, const CueKind& kind, const Strategy& strategy) const;
  void run_sessions(const CueKind& kind, const Strategy& strategy, int count, OwnSessions& own);
  std::optional<Reached> same_everywhere(const CueKind& kind, const Strategy& strategy,
                                         const Cells& all) const;
  Reached by_itself(const CueKind& kind, const Strategy& strategy, const Cells& all);
  CueReport report(const CueKind& kind, const Cells& all);
  double guessing() const { return 1.0 / static_cast<double>(asked_.answers); }
  double chance(const Score& score) const { return std::max(guessing(), score.one_key()); }

  const Protocol& protocol_;
  const std::stop_token& stop_;
  const Steps& steps_;
  Asked asked_;
  CueTable table_;
  int points_ = 256;
  double turn_ = 0.5;
  std::map<protocol::Factors, std::vector<Presentation>> presentations_;
  std::map<std::pair<std::vector<std::vector<std::string>>, protocol::Factors>, std::vector<Interval>>
      intervals_;
  std::vector<OwnSessions> own_sessions_;
};

Interval Guard::interval_of(const std::vector<std::string>& scenes, const protocol::Factors& factors) {
  const auto cues = [&](const std::string& scene) {
    const auto found = table_.find(scene, factors);
    if (!found) throw NotPlanned("scene \"" + scene + "\" at " + protocol::format(factors));
    return *found;
  };
  const double longest_s = protocol_.task.duration_s.value_or(protocol_.timing.explore_s.value_or(0));
  return {cues(scenes.front()), cues(scenes.back()),
          longest_s - 1e-3 * protocol_.scenes.at(scenes.front()).ramp_ms};
}

const std::vector<Interval>& Guard::intervals_of(const TrialSpec& trial) {
  auto& intervals = intervals_[{trial.intervals, trial.factors}];
  if (intervals.empty())
    for (const auto& scenes : trial.intervals) intervals.push_back(interval_of(scenes, trial.factors));
  return intervals;
}

const std::vector<Presentation>& Guard::presentations(const protocol::Factors& cell,
                                                      const TrialCensus& census) {
  const auto [found, is_new] = presentations_.try_emplace(cell);
  auto& all = found->second;
  if (!is_new) return all;
  const auto orders = trial::orders_of(protocol_.task);
  const auto combinations = census.combinations(cell);
  for (const auto& factors : combinations)
    for (const auto& order : orders) {
      const auto correct = order.correct ? order.correct : trial::correct_choice(protocol_.task, factors);
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

Cells Guard::cells_of(const TrialCensus& census) {
  Cells cells;
  for (const auto& [cell, trials] : census.cells()) cells.emplace_back(&presentations(cell, census), trials);
  return cells;
}

// Roving varies the strength of stimuli at random, with a uniform distribution. Here a low-discrepancy
// sequence (Roberts 2018), with one dimension per interval, replaces the random draws, because fewer points
// are then enough.
std::vector<Look> Guard::looks(const CueKind& kind, Feature feature, const Cells& cells, Draws draws) const {
  const double g = asked_.intervals > 3 ? 1.1673039782614187 : 1.2207440846057596;
  const double steps[] = {1 / g, 1 / (g * g), 1 / (g * g * g), 1 / (g * g * g * g)};
  const auto moves = [&](const Interval& interval) {
    const bool by_edge = interval.first.low || interval.last.low;
    return interval.first.rove_dB > 0 && kind.source == Source::surface && (kind.follows_strength || by_edge);
  };
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
          look.x[i] = number_of(kind, intervals[i], feature, intervals[i].first.rove_dB * (2 * u - 1));
        }
        looks.push_back(look);
      }
    }
  return looks;
}

Score Guard::score(const CueKind& kind, const Strategy& strategy, const Cells& cells) const {
  Score score;
  for (const auto& look : looks(kind, strategy.feature, cells, Draws::to_judge)) {
    const auto correct = static_cast<std::size_t>(look.correct);
    score.trials += look.weight, score.keys[correct] += look.weight;
    score.right += look.weight * shares(strategy.rule, asked_, look.x)[correct];
  }
  return score;
}

int Guard::answer(const CueKind& kind, const Strategy& strategy, const TrialSpec& trial, std::uint64_t seed) {
  const auto& intervals = intervals_of(trial);
  CueValues x{};
  for (std::size_t i = 0; i < intervals.size(); ++i)
    x[i] = number_of(kind, intervals[i], strategy.feature, trial.rove_dB[i]);
  const auto answers = shares(strategy.rule, asked_, x);
  random::Draws draws(
      {seed, random::Stream::observer, trial.block_index, trial.attempt, trial.trial_in_block});
  double left = draws.uniform();
  int choice = 0;
  while (choice + 1 < static_cast<int>(asked_.answers) && left >= answers[static_cast<std::size_t>(choice)])
    left -= answers[static_cast<std::size_t>(choice++)];
  return choice;
}

std::vector<Shares> Guard::answers_to(const Cells& cells, const CueKind& kind,
                                      const Strategy& strategy) const {
  std::vector<Shares> answers;
  for (const auto& look : looks(kind, strategy.feature, cells, Draws::to_judge))
    answers.push_back(shares(strategy.rule, asked_, look.x));
  return answers;
}

// Simulates sessions until there are `count`.
void Guard::run_sessions(const CueKind& kind, const Strategy& strategy, int count, OwnSessions& own) {
  while (static_cast<int>(own.done.size()) < count) {
    if (stop_.stop_requested()) throw protocol::Abandoned();
    if (steps_.finish.stop_requested()) throw Finished();
    const auto seed = static_cast<std::uint64_t>(own.done.size());
    const auto census = census_of_session(
        protocol_, seed, [&](const TrialSpec& trial) { return answer(kind, strategy, trial, seed); });
    Score sum;
    for (const auto& [presentations, trials] : cells_of(census)) {
      const auto [found, is_new] = own.scores.try_emplace(presentations);
      if (is_new) found->second = score(kind, strategy, {{presentations, 1.0}});
      sum.add(found->second, trials);
    }
    own.done.push_back(sum);
  }
}

// Returns the accuracy of a rule that is equally good at every level; empty if the accuracy depends on the
// level. Such a rule needs no simulated sessions: whichever levels its answers lead to, the accuracy is the
// same.
std::optional<Reached> Guard::same_everywhere(const CueKind& kind, const Strategy& strategy,
                                              const Cells& all) const {
  if (protocol_.task.kind == TaskKind::single_interval) return std::nullopt;
  double low = 1, high = 0;
  for (const auto& cell : all) {
    const auto here = score(kind, strategy, {cell});
    low = std::min(low, here.accuracy()), high = std::max(high, here.accuracy());
  }
  if (high - low > 2 * precision) return std::nullopt;
  const double by_guessing = chance(score(kind, strategy, all));
  return Reached{std::max(0.5 * (low + high), by_guessing), by_guessing, 0.5 * (high - low)};
}

// Only the first sessions determine the number of sessions. If later results influenced that number, the
// accuracy would be biased.
Reached Guard::by_itself(const CueKind& kind, const Strategy& strategy, const Cells& all) {
  if (const auto same = same_everywhere(kind, strategy, all)) return *same;
  for (const auto& known : own_sessions_)
    if (answers_to(known.visited, kind, strategy) == known.answers) return known.reached;
  OwnSessions own;
  run_sessions(kind, strategy, first_sessions, own);
  const double error = 3 * standard_error(own.done) / precision;
  run_sessions(kind, strategy,
               static_cast<int>(std::min<double>(most_sessions, first_sessions * error * error)), own);
  const auto sum = sum_of(own.done);
  own.reached = {std::max(sum.accuracy(), chance(sum)), chance(sum), 3 * standard_error(own.done)};
  for (const auto& [presentations, unused] : own.scores) own.visited.emplace_back(presentations, 1.0);
  own.answers = answers_to(own.visited, kind, strategy);
  return own_sessions_.emplace_back(std::move(own)).reached;
}

CueReport Guard::report(const CueKind& kind, const Cells& all) {
  CueReport report;
  report.cue = kind.name, report.unit = kind.unit;
  const auto task = protocol_.task.kind;
  const bool change = kind.source == Source::surface && task == TaskKind::single_interval &&
                      protocol_.task.intervals.front().size() > 1;
  auto features = std::vector<Feature>{Feature::last};
  if (change) features.insert(features.end(), {Feature::change, Feature::first});
  Grain grain{smallest_difference_dB, 0};
  Strategy best;
  double most = -1;
  for (const auto feature : features) {
    const auto looked = looks(kind, feature, all, Draws::to_choose);
    if (feature == Feature::last) {
      std::tie(report.low, report.high) = range_of(looked, asked_.intervals);
      if (std::string(kind.unit) != "dB")
        grain = {smallest_difference * std::max(std::fabs(report.low), std::fabs(report.high)),
                 smallest_difference};
    }
    const Strategy strategy{feature, best_rule(asked_, looked, grain)};
    const double right = accuracy(strategy.rule, asked_, looked);
    if (right > most) most = right, best = strategy;
  }
  const auto reached = score(kind, best, all);
  report.chance = kind.source == Source::nothing ? guessing() : chance(reached);
  report.accuracy = std::max(reached.accuracy(), report.chance);
  if (levels_follow_right_answers(protocol_) && kind.source != Source::nothing) {
    report.whole_sessions = by_itself(kind, best, all);
    const auto& [accuracy, chance, error] = *report.whole_sessions;
    if (accuracy - chance > report.accuracy - report.chance)
      report.accuracy = accuracy, report.chance = chance, report.error = error;
  }
  report.low *= kind.scale, report.high *= kind.scale;
  return report;
}

void Guard::add_reports(CueGuard& guard) {
  const auto all = cells_of(census_of(protocol_));
  std::size_t count = 0;
  for (const auto& [presentations, trials] : all) count += presentations->size();
  if (count == 0) return;
  points_ = std::clamp(static_cast<int>(40'000 / (count + 1)), 16, 256);
  for (const auto& kind : cue_kinds) {
    if (steps_.finish.stop_requested()) throw Finished();
    guard.reports.push_back(report(kind, all));
    if (steps_.progress)
      steps_.progress("cues compared", static_cast<int>(guard.reports.size()), std::size(cue_kinds));
  }
}

}  // namespace

CueGuard cue_guard(const Protocol& protocol, const rig::Rig& rig, const protocol::Survey& survey,
                   const std::stop_token& stop, const Steps& steps) {
  CueGuard guard;
  if (protocol.task.kind == TaskKind::adjustment) {
    guard.nothing_to_tell = "in an adjustment no setting is right or wrong";
    return guard;
  }
  if (protocol::judges(protocol.task)) {
    guard.nothing_to_tell = "no rating and no number is right or wrong";
    return guard;
  }
  try {
    Guard(protocol, rig, survey, stop, steps).add_reports(guard);
    if (guard.reports.empty()) guard.nothing_to_tell = "no answer outside practice is right or wrong";
  } catch (const NotPlanned& missing) {
    guard.not_compared = missing.what();
    guard.reports.clear();
  } catch (const Finished&) {
    guard.stopped = true;
  }
  return guard;
}

}  // namespace turnpoint::simulation

#include "tests/rehearsal/cue_brute_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "station/protocol/resolve.hpp"
#include "station/protocol/sources.hpp"
#include "station/trial/orders.hpp"
#include "tests/rehearsal/cue_sessions.hpp"
#include "tests/rehearsal/cue_strategies.hpp"
#include "tests/rehearsal/cue_world.hpp"

namespace turnpoint::tests {

namespace {

using protocol::TaskKind;

Shown shown(const std::vector<Seen>& seen, std::size_t cue, int feature) {
  Shown shown;
  for (const auto& trial : seen) shown[{seen_numbers(trial.intervals, cue, feature), trial.correct}] += 1;
  return shown;
}

bool follows_answers(const protocol::Protocol& protocol) { return sets_levels(protocol.procedures.front()); }

/// True if one of two answers is right at level zero and the other on both sides of zero, or on the one side
/// that has levels: the answers say whether there is a signal.
bool asks_for_signal(const protocol::Protocol& protocol) {
  const auto right_at = [&](double level) {
    auto factors = protocol::any_factors(protocol);
    factors[protocol.procedures.front().level] = level;
    return trial::correct_choice(protocol.task, factors, trial::orders_of(protocol.task).front().intervals);
  };
  double lowest = 0, highest = 0;
  for (const auto& source : protocol::sources_of(protocol))
    for (const double level : source.levels)
      lowest = std::min(lowest, level), highest = std::max(highest, level);
  const auto none = right_at(0), below = right_at(lowest), above = right_at(highest);
  const auto signal = lowest < 0 ? below : above;
  const bool one_signal = lowest == 0 || highest == 0 || below == above;
  return protocol.task.choices.size() == 2 && none && signal && one_signal && *signal != *none;
}

/// True if an observer with a cue does sessions of its own.
bool does_sessions(const protocol::Protocol& protocol) {
  const auto& spec = protocol.procedures.front();
  return sets_levels(spec) && (spec.tracks.empty() || asks_for_signal(protocol));
}

/// Counts the same trials so that the first answer is right `odds` times as often as each other.
Shown by_answer(Shown shown, double odds) {
  std::array<double, 9> keys{};
  for (const auto& [trial, count] : shown) keys[static_cast<std::size_t>(trial.second)] += count;
  for (auto& [trial, count] : shown)
    count *= (trial.second == 0 ? odds : 1) / keys[static_cast<std::size_t>(trial.second)];
  return shown;
}

double one_key(const std::vector<Seen>& seen) {
  std::array<double, 9> keys{};
  for (const auto& trial : seen) keys[static_cast<std::size_t>(trial.correct)] += 1;
  return *std::max_element(keys.begin(), keys.end()) / static_cast<double>(seen.size());
}

/// With two scenes in an interval, the observer can also use the change of a cue or its value in the first
/// scene.
int features_of(const protocol::Protocol& protocol, std::size_t cue) {
  const bool two_scenes =
      protocol.task.kind == TaskKind::single_interval && protocol.task.intervals.front().size() > 1;
  return two_scenes && cue < 6 ? 3 : 1;
}

/// Finds the best strategy for this cue in these trials, over all features and rules. With odds, the trials
/// are weighted so that the first answer is right this many times as often as each other.
Candidate best_strategy(const protocol::Protocol& protocol, const std::vector<Seen>& seen, std::size_t cue,
                        std::optional<double> odds) {
  const auto kind = protocol.task.kind;
  const bool single = kind == TaskKind::single_interval, distance = kind == TaskKind::same_different;
  const auto answers = static_cast<int>(protocol.task.choices.size());
  std::vector<double> values;
  for (const auto& trial : seen)
    for (const auto& interval : trial.intervals) values.push_back(interval.last[cue]);
  const double grain = grain_of(cue, values);
  Candidate best;
  double chosen = -1;
  for (int feature = 0; feature < features_of(protocol, cue); ++feature) {
    auto looked = shown(seen, cue, feature);
    if (odds) looked = by_answer(std::move(looked), *odds);
    const auto strategy = single && answers > 2 ? best_parts(looked, grain, answers)
                          : single || distance  ? best_cuts(looked, grain, distance)
                                                : best_choice(looked, cue, kind);
    const double here = expected(strategy, looked);
    if (here > chosen + 1e-9) chosen = here, best = {cue, feature, strategy};
  }
  return best;
}

/// The gain of an observer with a cue in sessions of its own. In a task with one interval and two answers,
/// the answers decide how often each answer is right, so the observer tries many strategies: the best ones
/// for many odds of the first answer, and criteria and bands everywhere.
OwnSessions gain_of_cue(const protocol::Protocol& protocol, World& world, Tournament& tournament,
                        const std::vector<Seen>& seen, const Candidate& best) {
  if (protocol.task.kind != TaskKind::single_interval) return judged_gain(protocol, world, best);
  std::vector<Candidate> others{best};
  for (int k = -4; k <= 4; ++k) others.push_back(best_strategy(protocol, seen, best.cue, std::pow(1.7, k)));
  return tournament.best_gain(best.cue, features_of(protocol, best.cue), others);
}

}  // namespace

std::vector<BruteForce> cue_brute_force(const protocol::Protocol& protocol, const rig::Rig& rig) {
  World world(protocol, rig);
  auto seen = watch(protocol, world);
  const auto half = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  const std::vector<Seen> other(half, seen.end());
  seen.erase(half, seen.end());
  const double guess = 1.0 / static_cast<double>(protocol.task.choices.size());
  Tournament tournament(protocol, world, seen);
  std::vector<BruteForce> all;
  for (std::size_t cue = 0; cue < cue_names.size(); ++cue) {
    const bool no_cue = cue_names[cue] == "always the same key";
    BruteForce result{cue_names[cue]};
    const auto best = best_strategy(protocol, seen, cue, std::nullopt);
    result.accuracy = expected(best.strategy, shown(other, cue, best.feature));
    if (no_cue ? follows_answers(protocol) : does_sessions(protocol)) {
      const auto own =
          no_cue ? gain_of_keys(protocol, world) : gain_of_cue(protocol, world, tournament, seen, best);
      result.own_gain = own.gain, result.own_error = own.error;
    }
    result.chance = no_cue ? guess : std::max(guess, one_key(other));
    result.error = std::sqrt(result.accuracy * (1 - result.accuracy) / static_cast<double>(other.size()));
    all.push_back(result);
  }
  return all;
}

}  // namespace turnpoint::tests

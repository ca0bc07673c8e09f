#include "tests/simulation/cue_brute_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <random>

#include "station/protocol/resolve.hpp"
#include "station/protocol/sources.hpp"
#include "station/scene/planner.hpp"
#include "station/trial/director.hpp"
#include "station/trial/orders.hpp"
#include "tests/simulation/cue_strategies.hpp"

namespace turnpoint::tests {

namespace {

using protocol::TaskKind;
using trial::TrialSpec;

// Half of the simulated trials are used to choose the rule, the other half to measure its accuracy.
constexpr int watched_trials = 50'000, most_watched_sessions = 20'000;

/// The values of the eight cues in one interval, for the last and the first scene of the interval.
struct Numbers {
  std::vector<double> last, first;
};
const std::vector<std::string> cue_names = {
    "pitch",       "loudness", "amplitude at the wide end", "stripe pitch at the wide end", "edge sharpness",
    "strip width", "duration", "always the same key"};

struct Seen {
  std::vector<Numbers> intervals;
  int correct = 0;
};

/// Counts for one session: right answers of the observer, and right answers that pressing always the same key
/// would give, for each key.
struct Count {
  double trials = 0, right = 0;
  std::array<double, 9> keys{};

  void add(const Count& other) {
    trials += other.trials, right += other.right;
    for (std::size_t i = 0; i < keys.size(); ++i) keys[i] += other.keys[i];
  }
};

class World {
 public:
  World(const protocol::Protocol& protocol, const rig::Rig& rig) : protocol_(protocol), planner_(rig) {}

  std::vector<Numbers> look(const TrialSpec& trial) {
    std::vector<Numbers> all;
    for (std::size_t i = 0; i < trial.intervals.size(); ++i) {
      const auto& scenes = trial.intervals[i];
      all.push_back({numbers(scenes.back(), trial, trial.rove_dB[i]),
                     numbers(scenes.front(), trial, trial.rove_dB[i])});
      const double longest_s =
          protocol_.task.duration_s ? *protocol_.task.duration_s : *protocol_.timing.explore_s;
      const double duration_s = longest_s - protocol_.scenes.at(scenes.front()).ramp_ms / 1000;
      for (auto* numbers : {&all.back().last, &all.back().first}) {
        numbers->push_back(duration_s);
        numbers->push_back(0);
      }
    }
    return all;
  }

 private:
  std::vector<double> numbers(const std::string& scene, const TrialSpec& trial, double rove_dB) {
    auto& known = known_[scene][trial.factors];
    if (!known) known = planner_.plan(protocol::resolve(protocol_, scene, trial.factors, 0)).cues;
    auto cues = *known;
    if (cues.pitch_Hz > 0) cues.loudness_dB += rove_dB;
    return {cues.pitch_Hz,       cues.loudness_dB,  cues.wide_end_amplitude_m * std::pow(10, rove_dB / 20),
            cues.stripe_pitch_m, cues.edge_width_m, cues.strip_width_m};
  }

  const protocol::Protocol& protocol_;
  scene::Planner planner_;
  std::map<std::string, std::map<protocol::Factors, std::optional<scene::Cues>>> known_;
};

double seen_number(const Numbers& numbers, std::size_t cue, int feature) {
  if (feature == 0) return numbers.last[cue];
  return feature == 1 ? numbers.last[cue] - numbers.first[cue] : numbers.first[cue];
}

std::vector<double> seen_numbers(const std::vector<Numbers>& intervals, std::size_t cue, int feature) {
  std::vector<double> x;
  for (const auto& interval : intervals) x.push_back(seen_number(interval, cue, feature));
  return x;
}

Shown shown(const std::vector<Seen>& seen, std::size_t cue, int feature) {
  Shown shown;
  for (const auto& trial : seen) shown[{seen_numbers(trial.intervals, cue, feature), trial.correct}] += 1;
  return shown;
}

void run_session(const protocol::Protocol& protocol, std::uint64_t seed,
                 const std::function<std::optional<int>(const TrialSpec&)>& answer) {
  trial::Director director(protocol, 0, seed);
  while (director.block() != nullptr) {
    while (const auto trial = director.next()) {
      trial::TrialEnd end;
      end.response = answer(*trial);
      end.outcome = end.response ? terms::Outcome::answered : terms::Outcome::timeout;
      if (trial->correct && end.response) end.correct = *trial->correct == *end.response;
      if (director.block()->practice) end.correct = true;
      director.record(end);
    }
    director.finish_block();
  }
}

bool follows_answers(const procedure::Spec& spec) { return spec.kind != procedure::Kind::constant_stimuli; }

bool follows_answers(const protocol::Protocol& protocol) {
  return follows_answers(protocol.procedures.front());
}

/// True if one of two answers is right at level zero and the other on both sides of zero, or on the one side
/// that has levels: the answers say whether there is a signal.
bool asks_for_signal(const protocol::Protocol& protocol) {
  const auto right_at = [&](double level) {
    auto factors = protocol::any_factors(protocol);
    factors[protocol.procedures.front().level] = level;
    return trial::correct_choice(protocol.task, factors);
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
  return follows_answers(spec) && (spec.tracks.empty() || asks_for_signal(protocol));
}

/// Collects what an observer can perceive in whole sessions. If a procedure chooses levels by the answers, a
/// random level that it can present is used instead.
std::vector<Seen> watch(const protocol::Protocol& protocol, World& world) {
  std::vector<Seen> seen;
  std::mt19937 random(1);
  std::map<std::string, std::pair<std::string, std::vector<double>>> levels;
  for (const auto& source : protocol::sources_of(protocol))
    if (source.spec && follows_answers(*source.spec))
      levels[source.spec->name] = {source.level, source.levels};
  for (std::uint64_t seed = 5000; seen.size() < watched_trials && seed < 5000 + most_watched_sessions; ++seed)
    run_session(protocol, seed, [&](const TrialSpec& given) -> std::optional<int> {
      auto trial = given;
      if (const auto found = levels.find(trial.procedure); found != levels.end()) {
        const auto& [factor, values] = found->second;
        trial.factors[factor] = values[random() % values.size()];
        if (protocol.task.kind == TaskKind::single_interval)
          trial.correct = trial::correct_choice(protocol.task, trial.factors);
      }
      if (trial.type != terms::TrialType::practice && trial.correct)
        seen.push_back({world.look(trial), *trial.correct});
      return static_cast<int>(random() % protocol.task.choices.size());
    });
  return seen;
}

struct OwnSessions {
  double gain = 0, error = 0;
};

/// How many sessions to simulate at least, and from which seed on.
struct Sessions {
  std::size_t count;
  double trials;
  std::uint64_t first_seed;
};
constexpr Sessions to_judge{600, 25'000, 50'000}, to_try{40, 0, 90'000};

/// Simulates whole sessions in which this observer gives every answer, so its answers also steer the
/// procedure. Returns the counts of each session.
std::vector<Count> do_sessions(const protocol::Protocol& protocol, World& world, std::size_t cue, int feature,
                               const Strategy& strategy, Sessions wanted) {
  std::vector<Count> each;
  double trials = 0;
  std::mt19937 random(1);
  while (each.size() < wanted.count || trials < wanted.trials) {
    Count count;
    run_session(protocol, wanted.first_seed + each.size(), [&](const TrialSpec& trial) -> std::optional<int> {
      const auto answers = strategy(seen_numbers(world.look(trial), cue, feature));
      const int answer = answers[random() % answers.size()];
      if (trial.type != terms::TrialType::practice && trial.correct) {
        count.trials += 1, count.right += answer == *trial.correct ? 1 : 0;
        count.keys[static_cast<std::size_t>(*trial.correct)] += 1;
      }
      return answer;
    });
    trials += count.trials;
    each.push_back(count);
  }
  return each;
}

/// Returns by how much the accuracy in these sessions exceeds that of guessing or, if `key` is given, of
/// always pressing this key.
OwnSessions gain_over(const std::vector<Count>& each, std::optional<std::size_t> key, double guess) {
  Count all;
  for (const auto& count : each) all.add(count);
  const auto more = [&](const Count& c) { return c.right - (key ? c.keys[*key] : guess * c.trials); };
  OwnSessions own{more(all) / all.trials, 0};
  double squares = 0;
  for (const auto& count : each) squares += std::pow(more(count) - own.gain * count.trials, 2);
  own.error = std::sqrt(squares) / all.trials;
  own.gain = std::max(own.gain, 0.0);
  return own;
}

/// The gain of an observer with a cue over guessing or over always pressing the same key, whichever is
/// better in its sessions.
OwnSessions gain_of(const std::vector<Count>& each, double guess) {
  Count all;
  for (const auto& count : each) all.add(count);
  const auto key =
      static_cast<std::size_t>(std::max_element(all.keys.begin(), all.keys.end()) - all.keys.begin());
  return all.keys[key] > guess * all.trials ? gain_over(each, key, guess) : gain_over(each, {}, guess);
}

/// The gain over guessing of an observer who always presses the same key, with the best key.
OwnSessions gain_of_keys(const protocol::Protocol& protocol, World& world, double guess) {
  OwnSessions best;
  for (int key = 0; key < static_cast<int>(protocol.task.choices.size()); ++key) {
    const auto press = [key](const std::vector<double>&) { return std::vector<int>{key}; };
    const auto own = gain_over(do_sessions(protocol, world, 0, 0, press, to_judge), {}, guess);
    if (own.gain > best.gain) best = own;
  }
  return best;
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

struct Best {
  Strategy strategy;
  int feature = 0;
};

/// Finds the best strategy for this cue in these trials, over all features and rules. With odds, the trials
/// are weighted so that the first answer is right this many times as often as each other.
Best best_strategy(const protocol::Protocol& protocol, const std::vector<Seen>& seen, std::size_t cue,
                   std::optional<double> odds) {
  const auto kind = protocol.task.kind;
  const bool single = kind == TaskKind::single_interval, distance = kind == TaskKind::same_different;
  const bool two_scenes = single && protocol.task.intervals.front().size() > 1;
  const auto answers = static_cast<int>(protocol.task.choices.size());
  double largest = 0;
  for (const auto& trial : seen)
    for (const auto& interval : trial.intervals) largest = std::max(largest, std::fabs(interval.last[cue]));
  const double grain = cue == loudness ? 0.01 : 1e-3 * largest;
  Best best;
  double chosen = -1;
  for (int feature = 0; feature < (two_scenes && cue < 6 ? 3 : 1); ++feature) {
    auto looked = shown(seen, cue, feature);
    if (odds) looked = by_answer(std::move(looked), *odds);
    const auto strategy = single && answers > 2 ? best_parts(looked, grain, answers)
                          : single || distance  ? best_cuts(looked, grain, distance)
                                                : best_choice(looked, cue, kind);
    const double here = expected(strategy, looked);
    if (here > chosen + 1e-9) chosen = here, best = {strategy, feature};
  }
  return best;
}

/// Strategies with one criterion or with a band, at places spread over the values of a cue. Of the two ways
/// to answer, the one that is right more often if both answers are right equally often.
std::vector<Best> criteria(const std::vector<Seen>& seen, std::size_t cue, int features) {
  std::vector<Best> all;
  for (int feature = 0; feature < features; ++feature) {
    std::vector<double> values;
    for (const auto& trial : seen) values.push_back(seen_number(trial.intervals.front(), cue, feature));
    std::sort(values.begin(), values.end());
    const auto looked = by_answer(shown(seen, cue, feature), 1);
    const auto place = [&](int k, int of) {
      return values[values.size() * static_cast<std::size_t>(k) / static_cast<std::size_t>(of)];
    };
    const auto add = [&](double from, double to) {
      const auto answer = [from, to](int inside) {
        return [from, to, inside](const std::vector<double>& x) {
          return std::vector<int>{x.front() > from && x.front() <= to ? inside : 1 - inside};
        };
      };
      all.push_back({answer(expected(answer(0), looked) >= 0.5 ? 0 : 1), feature});
    };
    for (int k = 1; k < 30; ++k) add(place(k, 30), std::numeric_limits<double>::infinity());
    for (int k = 1; k < 12; ++k)
      for (int l = k + 1; l < 12; ++l) add(place(k, 12), place(l, 12));
  }
  return all;
}

/// The gain of a strategy in sessions of its own, in more of them if they differ much from each other.
OwnSessions judged(const protocol::Protocol& protocol, World& world, std::size_t cue, const Best& one,
                   double guess) {
  const auto in = [&](Sessions wanted) {
    return gain_of(do_sessions(protocol, world, cue, one.feature, one.strategy, wanted), guess);
  };
  const auto own = in(to_judge);
  const double more = std::pow(own.error / 0.004, 2);
  if (more <= 1) return own;
  return in({static_cast<std::size_t>(600 * std::min(more, 20.0)), 0, to_judge.first_seed});
}

/// The gain of an observer with a cue in sessions of its own. In a task with one interval and two answers,
/// the answers decide how often each answer is right, so the observer tries many strategies in a few
/// sessions: the best ones for many odds of the first answer, and criteria everywhere.
OwnSessions gain_of_cue(const protocol::Protocol& protocol, World& world, const std::vector<Seen>& seen,
                        std::size_t cue, const Best& best, double guess) {
  auto most = judged(protocol, world, cue, best, guess);
  if (protocol.task.kind != TaskKind::single_interval) return most;
  std::vector<Best> tried;
  for (int k = -8; k <= 8; ++k) tried.push_back(best_strategy(protocol, seen, cue, std::pow(1.45, k)));
  const bool two_scenes = protocol.task.intervals.front().size() > 1;
  if (protocol.task.choices.size() == 2)
    for (auto& one : criteria(seen, cue, two_scenes && cue < 6 ? 3 : 1)) tried.push_back(std::move(one));
  std::vector<std::pair<double, std::size_t>> gains;
  for (std::size_t k = 0; k < tried.size(); ++k) {
    const auto& one = tried[k];
    const auto few = do_sessions(protocol, world, cue, one.feature, one.strategy, to_try);
    gains.emplace_back(-gain_of(few, guess).gain, k);
  }
  std::sort(gains.begin(), gains.end());
  for (std::size_t k = 0; k < std::min<std::size_t>(4, gains.size()); ++k)
    if (const auto own = judged(protocol, world, cue, tried[gains[k].second], guess); own.gain > most.gain)
      most = own;
  return most;
}

}  // namespace

std::vector<BruteForce> cue_brute_force(const protocol::Protocol& protocol, const rig::Rig& rig) {
  World world(protocol, rig);
  auto seen = watch(protocol, world);
  const auto half = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  const std::vector<Seen> other(half, seen.end());
  seen.erase(half, seen.end());
  const double guess = 1.0 / static_cast<double>(protocol.task.choices.size());
  std::vector<BruteForce> all;
  for (std::size_t cue = 0; cue < cue_names.size(); ++cue) {
    const bool no_cue = cue_names[cue] == "always the same key";
    BruteForce result{cue_names[cue]};
    const auto best = best_strategy(protocol, seen, cue, std::nullopt);
    result.accuracy = expected(best.strategy, shown(other, cue, best.feature));
    if (no_cue ? follows_answers(protocol) : does_sessions(protocol)) {
      const auto own = no_cue ? gain_of_keys(protocol, world, guess)
                              : gain_of_cue(protocol, world, seen, cue, best, guess);
      result.own_gain = own.gain, result.own_error = own.error;
    }
    result.chance = no_cue ? guess : std::max(guess, one_key(other));
    result.error = std::sqrt(result.accuracy * (1 - result.accuracy) / static_cast<double>(other.size()));
    all.push_back(result);
  }
  return all;
}

}  // namespace turnpoint::tests

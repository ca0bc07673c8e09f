#include "tests/simulation/cue_brute_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
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
constexpr std::size_t own_sessions = 400;
constexpr double own_trials = 25'000;

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

bool follows_right_answers(const protocol::Protocol& protocol) {
  return follows_answers(protocol.procedures.front()) && protocol.procedures.front().tracks.empty();
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

/// Simulates whole sessions in which this observer gives every answer, so its answers also steer the
/// procedure. Returns by how much its accuracy exceeds that of guessing or of always pressing the same key,
/// whichever is better.
OwnSessions do_sessions(const protocol::Protocol& protocol, World& world, std::size_t cue, int feature,
                        const Strategy& strategy) {
  std::vector<Count> each;
  Count all;
  std::mt19937 random(1);
  while (each.size() < own_sessions || all.trials < own_trials) {
    Count count;
    run_session(protocol, 50'000 + each.size(), [&](const TrialSpec& trial) -> std::optional<int> {
      const auto answers = strategy(seen_numbers(world.look(trial), cue, feature));
      const int answer = answers[random() % answers.size()];
      if (trial.type != terms::TrialType::practice && trial.correct) {
        count.trials += 1, count.right += answer == *trial.correct ? 1 : 0;
        count.keys[static_cast<std::size_t>(*trial.correct)] += 1;
      }
      return answer;
    });
    all.add(count);
    each.push_back(count);
  }
  const auto key =
      static_cast<std::size_t>(std::max_element(all.keys.begin(), all.keys.end()) - all.keys.begin());
  const double guess = 1.0 / static_cast<double>(protocol.task.choices.size());
  const bool by_key = all.keys[key] > guess * all.trials;
  const auto more = [&](const Count& c) { return c.right - (by_key ? c.keys[key] : guess * c.trials); };
  OwnSessions own{more(all) / all.trials, 0};
  double squares = 0;
  for (const auto& count : each) squares += std::pow(more(count) - own.gain * count.trials, 2);
  own.error = std::sqrt(squares) / all.trials;
  own.gain = std::max(own.gain, 0.0);
  return own;
}

double one_key(const std::vector<Seen>& seen) {
  std::array<double, 9> keys{};
  for (const auto& trial : seen) keys[static_cast<std::size_t>(trial.correct)] += 1;
  return *std::max_element(keys.begin(), keys.end()) / static_cast<double>(seen.size());
}

}  // namespace

std::vector<BruteForce> cue_brute_force(const protocol::Protocol& protocol, const rig::Rig& rig) {
  World world(protocol, rig);
  auto seen = watch(protocol, world);
  const auto half = seen.begin() + static_cast<std::ptrdiff_t>(seen.size() / 2);
  const std::vector<Seen> other(half, seen.end());
  seen.erase(half, seen.end());
  const auto kind = protocol.task.kind;
  const bool two_scenes = kind == TaskKind::single_interval && protocol.task.intervals.front().size() > 1;
  const bool distance = kind == TaskKind::same_different;
  std::vector<BruteForce> all;
  for (std::size_t cue = 0; cue < cue_names.size(); ++cue) {
    double largest = 0;
    for (const auto& trial : seen)
      for (const auto& interval : trial.intervals) largest = std::max(largest, std::fabs(interval.last[cue]));
    const double grain = cue == loudness ? 0.01 : 1e-3 * largest;
    BruteForce result{cue_names[cue]};
    double chosen = -1;
    Strategy best;
    int best_feature = 0;
    for (int feature = 0; feature < (two_scenes && cue < 6 ? 3 : 1); ++feature) {
      const auto looked = shown(seen, cue, feature);
      const auto answers = static_cast<int>(protocol.task.choices.size());
      const bool several = kind == TaskKind::single_interval && answers > 2;
      const auto strategy = several ? best_parts(looked, grain, answers)
                            : kind == TaskKind::single_interval || distance
                                ? best_cuts(looked, grain, distance)
                                : best_choice(looked, cue, kind);
      const double here = expected(strategy, looked);
      if (here <= chosen + 1e-9) continue;
      chosen = here, best = strategy, best_feature = feature;
      result.accuracy = expected(strategy, shown(other, cue, feature));
    }
    if (follows_right_answers(protocol) && cue_names[cue] != "always the same key") {
      const auto own = do_sessions(protocol, world, cue, best_feature, best);
      result.own_gain = own.gain, result.own_error = own.error;
    }
    const double guess = 1.0 / static_cast<double>(protocol.task.choices.size());
    result.chance = cue_names[cue] == "always the same key" ? guess : std::max(guess, one_key(other));
    result.error = std::sqrt(result.accuracy * (1 - result.accuracy) / static_cast<double>(other.size()));
    all.push_back(result);
  }
  return all;
}

}  // namespace turnpoint::tests

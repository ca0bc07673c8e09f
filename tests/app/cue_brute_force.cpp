#include "tests/app/cue_brute_force.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <random>

#include "station/observer/observer.hpp"
#include "station/protocol/resolve.hpp"
#include "station/scene/planner.hpp"
#include "station/session/director.hpp"
#include "station/session/rows.hpp"

namespace turnpoint::tests {

namespace {

using protocol::TaskKind;
using session::TrialSpec;

constexpr int watched_sessions = 800, watched_trials = 24'000, enough_trials = 8000;

/// The eight numbers of one interval: of its last scene, of its first.
struct Numbers {
  std::vector<double> last, first;
};
const std::vector<std::string> cue_names = {
    "pitch",       "loudness", "amplitude at the wide end", "stripe pitch at the wide end", "edge sharpness",
    "strip width", "duration", "always the same key"};
constexpr std::size_t loudness = 1;

struct Seen {
  std::vector<Numbers> intervals;
  int correct = 0;
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
    auto& known = known_[{scene, trial.factors}];
    if (!known) known = planner_.plan(protocol::resolve(protocol_, scene, trial.factors, 0)).cues;
    auto cues = *known;
    if (cues.pitch_Hz > 0) cues.loudness_dB += rove_dB;
    return {cues.pitch_Hz,       cues.loudness_dB,  cues.wide_end_amplitude_m * std::pow(10, rove_dB / 20),
            cues.stripe_pitch_m, cues.edge_width_m, cues.strip_width_m};
  }

  const protocol::Protocol& protocol_;
  scene::Planner planner_;
  std::map<std::pair<std::string, protocol::Factors>, std::optional<scene::Cues>> known_;
};

/// Answers with -1 standing for "these are equal: guess among all that are".
using Strategy = std::function<std::vector<int>(const std::vector<double>&)>;

double seen_number(const Numbers& numbers, std::size_t cue, int feature) {
  if (feature == 0) return numbers.last[cue];
  return feature == 1 ? numbers.last[cue] - numbers.first[cue] : numbers.first[cue];
}

std::vector<double> seen_numbers(const std::vector<Numbers>& intervals, std::size_t cue, int feature) {
  std::vector<double> x;
  for (const auto& interval : intervals) x.push_back(seen_number(interval, cue, feature));
  return x;
}

double expected(const Strategy& strategy, const std::vector<Seen>& seen, std::size_t cue, int feature) {
  double right = 0;
  for (const auto& trial : seen) {
    const auto answers = strategy(seen_numbers(trial.intervals, cue, feature));
    if (std::count(answers.begin(), answers.end(), trial.correct))
      right += 1.0 / static_cast<double>(answers.size());
  }
  return right / static_cast<double>(seen.size());
}

// Every pair of cuts between values that differ, at most 80 of them, and both answers inside.
Strategy best_cuts(const std::vector<Seen>& seen, std::size_t cue, int feature, double grain, bool distance) {
  const auto number = [distance](const std::vector<double>& x) {
    return distance ? std::fabs(x[1] - x[0]) : x[0];
  };
  std::vector<std::pair<double, int>> values;
  for (const auto& trial : seen)
    values.emplace_back(number(seen_numbers(trial.intervals, cue, feature)), trial.correct);
  std::sort(values.begin(), values.end());
  std::vector<double> between;
  double from = values.front().first;
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i].first - from > grain) {
      between.push_back(0.5 * (values[i].first + values[i - 1].first));
      from = values[i].first;
    }
  std::vector<double> cuts{-1e300};
  const std::size_t wanted = std::min<std::size_t>(80, between.size());
  for (std::size_t i = 0; i < wanted; ++i) cuts.push_back(between[i * between.size() / wanted]);
  cuts.push_back(1e300);
  // How many of each answer lie below each cut.
  std::vector<std::array<double, 2>> below(cuts.size(), {0, 0});
  for (std::size_t c = 0; c < cuts.size(); ++c)
    for (const auto& [value, answer] : values)
      if (value < cuts[c]) below[c][static_cast<std::size_t>(answer)] += 1;
  double most = -1;
  std::size_t low = 0, high = cuts.size() - 1;
  int inside = 0;
  for (std::size_t a = 0; a < cuts.size(); ++a)
    for (std::size_t b = a + 1; b < cuts.size(); ++b) {
      for (const int answer : {0, 1}) {
        const auto in = static_cast<std::size_t>(answer), out = static_cast<std::size_t>(1 - answer);
        const double right =
            below[b][in] - below[a][in] + below.back()[out] - (below[b][out] - below[a][out]);
        if (right > most + 1e-9) most = right, low = a, high = b, inside = answer;
      }
    }
  return [=, lowest = cuts[low], highest = cuts[high]](const std::vector<double>& x) {
    const double value = number(x);
    return std::vector<int>{value >= lowest && value < highest ? inside : 1 - inside};
  };
}

std::vector<int> extremes(const std::vector<double>& score) {
  const double most = *std::max_element(score.begin(), score.end());
  std::vector<int> answers;
  for (std::size_t i = 0; i < score.size(); ++i)
    if (score[i] >= most - 1e-12 * std::fabs(most)) answers.push_back(static_cast<int>(i));
  return answers;
}

Strategy best_choice(const std::vector<Seen>& seen, std::size_t cue, int feature) {
  double usual = 0;
  for (const auto& trial : seen)
    if (trial.intervals.size() == 2)
      usual += seen_number(trial.intervals[static_cast<std::size_t>(1 - trial.correct)], cue, feature) /
               static_cast<double>(seen.size());
  Strategy best;
  double most = -1;
  for (const double sign : {1.0, -1.0})
    for (const bool unlike : {false, true}) {
      const Strategy strategy = [=](const std::vector<double>& x) {
        std::vector<double> score(x.size(), 0.0);
        const auto differ = [&](double a, double b) {
          const double none = cue == loudness ? 0.01 : 1e-3 * std::max(std::fabs(a), std::fabs(b));
          return std::fabs(a - b) > none ? a - b : 0.0;
        };
        for (std::size_t i = 0; i < x.size(); ++i) {
          if (unlike && x.size() == 2) score[i] = sign * std::fabs(differ(x[i], usual));
          for (std::size_t j = 0; j < x.size(); ++j)
            if (!(unlike && x.size() == 2))
              score[i] += sign * (unlike ? std::fabs(differ(x[i], x[j])) : differ(x[i], x[j]));
        }
        return extremes(score);
      };
      const double right = expected(strategy, seen, cue, feature);
      if (right > most + 1e-9) most = right, best = strategy;
    }
  return best;
}

void run_session(const protocol::Protocol& protocol, std::uint64_t seed,
                 const std::function<std::optional<int>(const TrialSpec&)>& answer) {
  session::Director director(protocol, 0, seed);
  while (director.block() != nullptr) {
    while (const auto trial = director.next()) {
      session::TrialEnd end;
      end.response = answer(*trial);
      end.outcome = end.response ? terms::Outcome::answered : terms::Outcome::timeout;
      if (trial->correct && end.response) end.correct = *trial->correct == *end.response;
      director.record(end);
    }
    director.finish_block();
  }
}

/// What can be seen in whole sessions of the simulated participant.
std::vector<Seen> watch(const protocol::Protocol& protocol, World& world) {
  std::vector<Seen> seen;
  const observer::Observer participant{observer::Parameters{}};
  // Where levels follow the answers, sessions differ much from one another.
  const bool fixed = protocol.procedures.front().kind == procedure::Kind::constant_stimuli;
  const std::size_t wanted = !fixed ? watched_trials : enough_trials;
  for (std::uint64_t seed = 5000; seen.size() < wanted && seed < 5000 + watched_sessions; ++seed)
    run_session(protocol, seed, [&](const TrialSpec& trial) -> std::optional<int> {
      if (trial.type != terms::TrialType::practice && trial.correct)
        seen.push_back({world.look(trial), *trial.correct});
      const auto reply = participant.answer(session::question_of(trial, protocol, seed));
      return reply.response_time_s <= trial.deadline_s ? reply.choice : std::nullopt;
    });
  return seen;
}

}  // namespace

std::vector<BruteForce> cue_brute_force(const protocol::Protocol& protocol, const rig::Rig& rig) {
  World world(protocol, rig);
  const auto seen = watch(protocol, world);
  const bool two_scenes =
      protocol.task.kind == TaskKind::single_interval && protocol.task.intervals.front().size() > 1;
  const auto kind = protocol.task.kind;
  std::vector<BruteForce> all;
  for (std::size_t cue = 0; cue < cue_names.size(); ++cue) {
    double largest = 0;
    for (const auto& trial : seen)
      for (const auto& interval : trial.intervals) largest = std::max(largest, std::fabs(interval.last[cue]));
    const double grain = cue == loudness ? 0.01 : 1e-3 * largest;
    BruteForce result{cue_names[cue], 0, static_cast<int>(seen.size())};
    for (int feature = 0; feature < (two_scenes && cue < 6 ? 3 : 1); ++feature) {
      const bool distance = kind == TaskKind::same_different;
      const auto strategy = kind == TaskKind::single_interval || distance
                                ? best_cuts(seen, cue, feature, grain, distance)
                                : best_choice(seen, cue, feature);
      result.accuracy = std::max(result.accuracy, expected(strategy, seen, cue, feature));
    }
    all.push_back(result);
  }
  return all;
}

}  // namespace turnpoint::tests

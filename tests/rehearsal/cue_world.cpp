#include "tests/rehearsal/cue_world.hpp"

#include <cmath>
#include <random>

#include "station/protocol/resolve.hpp"
#include "station/protocol/sources.hpp"
#include "station/trial/orders.hpp"

namespace turnpoint::tests {

using protocol::TaskKind;
using trial::TrialSpec;

namespace {

constexpr int watched_trials = 50'000, most_watched_sessions = 20'000;

}  // namespace

std::vector<Numbers> World::look(const TrialSpec& trial) {
  std::vector<Numbers> all;
  for (std::size_t i = 0; i < trial.intervals.size(); ++i) {
    const auto& scenes = trial.intervals[i];
    all.push_back(
        {numbers(scenes.back(), trial, trial.rove_dB[i]), numbers(scenes.front(), trial, trial.rove_dB[i])});
    const double longest_s = protocol_.task.duration_s
                                 ? protocol::evaluate(*protocol_.task.duration_s, trial.factors)
                                 : *protocol_.timing.explore_s;
    const double duration_s = longest_s - protocol_.scenes.at(scenes.front()).ramp_ms / 1000;
    for (auto* numbers : {&all.back().last, &all.back().first}) {
      numbers->push_back(duration_s);
      numbers->push_back(0);
    }
  }
  return all;
}

std::vector<double> World::numbers(const std::string& scene, const TrialSpec& trial, double rove_dB) {
  auto& known = known_[scene][trial.factors];
  if (!known) known = planner_.plan(protocol::resolve(protocol_, scene, trial.factors, 0)).cues;
  auto cues = *known;
  if (cues.pitch_Hz > 0) cues.loudness_dB += rove_dB;
  return {cues.pitch_Hz,       cues.loudness_dB,  cues.wide_end_amplitude_m * std::pow(10, rove_dB / 20),
          cues.stripe_pitch_m, cues.edge_width_m, cues.strip_width_m};
}

double seen_number(const Numbers& numbers, std::size_t cue, int feature) {
  if (feature == 0) return numbers.last[cue];
  return feature == 1 ? numbers.last[cue] - numbers.first[cue] : numbers.first[cue];
}

std::vector<double> seen_numbers(const std::vector<Numbers>& intervals, std::size_t cue, int feature) {
  std::vector<double> x;
  for (const auto& interval : intervals) x.push_back(seen_number(interval, cue, feature));
  return x;
}

void run_session(const protocol::Protocol& protocol, std::uint64_t seed,
                 const std::function<std::optional<int>(const TrialSpec&)>& answer) {
  trial::Director director(protocol, 0, seed);
  while (director.block() != nullptr) {
    while (const auto trial = director.next()) {
      trial::TrialEnd end;
      end.response = answer(*trial);
      end.outcome = end.response ? core::Outcome::answered : core::Outcome::timeout;
      if (trial->correct && end.response) end.correct = *trial->correct == *end.response;
      if (director.block()->practice) end.correct = true;
      director.record(end);
    }
    director.finish_block();
  }
}

bool sets_levels(const procedure::Spec& spec) { return spec.kind != procedure::Kind::constant_stimuli; }

std::vector<Seen> watch(const protocol::Protocol& protocol, World& world) {
  std::vector<Seen> seen;
  std::mt19937 random(1);
  std::map<std::string, std::pair<std::string, std::vector<double>>> levels;
  for (const auto& source : protocol::sources_of(protocol))
    if (source.spec && sets_levels(*source.spec)) levels[source.spec->name] = {source.level, source.levels};
  for (std::uint64_t seed = 5000; seen.size() < watched_trials && seed < 5000 + most_watched_sessions; ++seed)
    run_session(protocol, seed, [&](const TrialSpec& given) -> std::optional<int> {
      auto trial = given;
      if (const auto found = levels.find(trial.procedure); found != levels.end()) {
        const auto& [factor, values] = found->second;
        trial.factors[factor] = values[random() % values.size()];
        if (!protocol.task.correct_answer.empty())
          trial.correct = trial::correct_choice(protocol.task, trial.factors, trial.intervals);
      }
      if (trial.type != core::TrialType::practice && trial.correct)
        seen.push_back({world.look(trial), *trial.correct});
      return static_cast<int>(random() % protocol.task.choices.size());
    });
  return seen;
}

}  // namespace turnpoint::tests

#include "station/protocol/cue_guard.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "station/protocol/sources.hpp"

namespace turnpoint::protocol {

namespace {

enum class Roved { yes, no };

struct CueKind {
  const char* name;
  const char* unit;
  double scale;
  double scene::Cues::*cue;  ///< null: duration, which is the scene's and not the surface's
  Roved roved;               ///< whether a roved displacement blurs it

  double value(const Protocol& protocol, const Sight& sight) const {
    if (cue != nullptr) return sight.cues.*cue;
    const double longest_s = protocol.task.duration_s.value_or(protocol.timing.explore_s.value_or(0));
    return longest_s - 1e-3 * protocol.scenes.at(sight.scene).ramp_ms;
  }
};

constexpr CueKind cue_kinds[] = {
    {"pitch", "Hz", 1, &scene::Cues::pitch_Hz, Roved::no},
    {"loudness", "dB", 1, &scene::Cues::loudness_dB, Roved::no},
    {"amplitude at the wide end", "um", 1e6, &scene::Cues::wide_end_amplitude_m, Roved::yes},
    {"stripe pitch at the wide end", "mm", 1e3, &scene::Cues::stripe_pitch_m, Roved::no},
    {"edge sharpness", "mm", 1e3, &scene::Cues::edge_width_m, Roved::no},
    {"strip width", "mm", 1e3, &scene::Cues::strip_width_m, Roved::no},
    {"duration", "s", 1, nullptr, Roved::no},
};

// Nine strengths across the roving range stand for its uniform distribution. Sights are at its top.
std::vector<double> roved(double value, double rove_dB, Roved blurs) {
  if (blurs == Roved::no || rove_dB == 0) return {value};
  std::vector<double> values;
  for (int i = 0; i < 9; ++i) values.push_back(value * std::pow(10.0, -2 * rove_dB * i / 8 / 20));
  return values;
}

// Practice at levels of its own. Each combination is surveyed once, in the first block that has it: practice
// that runs a procedure has the main blocks' combinations, and those count.
bool is_practice(const Protocol& protocol, const std::string& block) {
  for (const auto& part : protocol.plan)
    if (block_of(part).name == block) return block_of(part).practice && block_of(part).procedures.empty();
  return false;
}

int right_answer(const Protocol& protocol, const Factors& known) {
  auto factors = any_factors(protocol);
  for (const auto& [name, value] : known) factors[name] = value;
  const auto& answers = protocol.task.correct_answer;
  for (std::size_t i = 0; i < answers.size(); ++i)
    if (holds(answers[i].second, factors)) return static_cast<int>(i);
  return -1;
}

std::vector<CueLook> looks_of_single(const Protocol& protocol, const Survey& survey, const CueKind& kind) {
  std::vector<CueLook> looks;
  const auto& scenes = protocol.task.intervals.front();
  const bool change = scenes.size() > 1;
  double before = 0;
  if (change)
    for (const auto& sight : survey.sights)
      if (sight.scene == scenes.front()) before = kind.value(protocol, sight);
  for (const auto& sight : survey.sights) {
    const int answer = sight.scene == scenes.back() ? right_answer(protocol, sight.factors) : -1;
    if (answer < 0 || is_practice(protocol, sight.block)) continue;
    const double rove_dB = protocol.scenes.at(sight.scene).rove_dB;
    for (const double value : roved(kind.value(protocol, sight), rove_dB, kind.roved))
      looks.push_back({value - before, answer});
  }
  return looks;
}

// Target against standard: one observer says "the larger one is the target". The standard is taken with the
// same factors, or its only plan.
std::vector<CueLook> looks_of_pair(const Protocol& protocol, const Survey& survey, const CueKind& kind,
                                   const std::string& standard, const std::string& target) {
  std::vector<CueLook> looks;
  for (const auto& sight : survey.sights) {
    if (sight.scene != target || is_practice(protocol, sight.block)) continue;
    for (const auto& other : survey.sights) {
      if (other.scene != standard || (!other.factors.empty() && other.factors != sight.factors)) continue;
      const double a_dB = protocol.scenes.at(target).rove_dB, b_dB = protocol.scenes.at(standard).rove_dB;
      for (const double a : roved(kind.value(protocol, sight), a_dB, kind.roved))
        for (const double b : roved(kind.value(protocol, other), b_dB, kind.roved)) {
          // Less than a thousandth is no difference: half of the guesses are right.
          const double difference =
              std::fabs(a - b) <= 1e-3 * std::max(std::fabs(a), std::fabs(b)) ? 0 : a - b;
          looks.push_back({difference, 1}), looks.push_back({-difference, 0});
        }
    }
  }
  return looks;
}

std::string standard_of(const Task& task) {
  if (!task.standard.empty()) return task.standard;
  for (const auto& interval : task.intervals)
    if (interval.back() != task.correct_scene) return interval.back();
  return "";
}

}  // namespace

CueCriterion best_criterion(std::vector<CueLook> looks) {
  CueCriterion best;
  if (looks.empty()) return best;
  std::sort(looks.begin(), looks.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  const double tie = 1e-3 * std::max(std::fabs(looks.front().value), std::fabs(looks.back().value));
  double total[2] = {0, 0}, below[2] = {0, 0};
  for (const auto& look : looks) total[look.answer] += 1;
  const double all = total[0] + total[1];
  // Always the same answer: everything is above.
  best = {looks.front().value, total[0] > total[1] ? 1 : 0, std::max(total[0], total[1]) / all};
  for (std::size_t i = 0; i + 1 < looks.size(); ++i) {
    below[looks[i].answer] += 1;
    if (looks[i + 1].value - looks[i].value <= tie) continue;
    const double low_is_0 = (below[0] + total[1] - below[1]) / all;
    const double accuracy = std::max(low_is_0, 1 - low_is_0);
    if (accuracy > best.accuracy)
      best = {0.5 * (looks[i].value + looks[i + 1].value), low_is_0 >= 0.5 ? 0 : 1, accuracy};
  }
  return best;
}

std::vector<CueReport> cue_guard(const Protocol& protocol, const Survey& survey) {
  const auto& task = protocol.task;
  std::vector<CueReport> reports;
  if (task.kind == TaskKind::adjustment || survey.sights.empty()) return reports;
  const bool single = task.kind == TaskKind::single_interval;
  const double chance = task.kind == TaskKind::oddity ? 1.0 / 3 : 0.5;
  for (const auto& kind : cue_kinds) {
    CueReport report;
    report.cue = kind.name, report.unit = kind.unit, report.chance = chance;
    report.low = report.high = kind.scale * (kind.value(protocol, survey.sights.front()));
    for (const auto& sight : survey.sights) {
      report.low = std::min(report.low, kind.scale * (kind.value(protocol, sight)));
      report.high = std::max(report.high, kind.scale * (kind.value(protocol, sight)));
    }
    const auto looks = single ? looks_of_single(protocol, survey, kind)
                              : looks_of_pair(protocol, survey, kind, standard_of(task),
                                              task.target.empty() ? task.correct_scene : task.target);
    const double two = best_criterion(looks).accuracy;
    // With three intervals, whoever tells a pair apart with probability p finds the odd one; else guesses.
    report.accuracy = task.kind == TaskKind::oddity ? 1.0 / 3 + (2 * two - 1) * 2.0 / 3 : two;
    reports.push_back(report);
  }
  CueReport key;
  key.cue = "always the same key";
  key.chance = chance;
  key.accuracy = single ? best_criterion([&] {
                            std::vector<CueLook> looks;
                            for (const auto& sight : survey.sights)
                              if (const int answer = right_answer(protocol, sight.factors);
                                  answer >= 0 && sight.scene == task.intervals.front().back() &&
                                  !is_practice(protocol, sight.block))
                                looks.push_back({0, answer});
                            return looks;
                          }())
                              .accuracy
                        : chance;
  reports.push_back(key);
  return reports;
}

}  // namespace turnpoint::protocol

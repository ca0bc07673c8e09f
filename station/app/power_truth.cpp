#include "station/app/power_truth.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "station/session/rows.hpp"

namespace turnpoint::app {

namespace {

using procedure::Kind;

std::string instruction_of(const protocol::Protocol& protocol, const protocol::Factors& factors) {
  for (const auto& name : {std::string("instruction"), protocol.analysis.by})
    if (const auto found = factors.find(name); found != factors.end())
      if (const auto* text = std::get_if<std::string>(&found->second)) return *text;
  return "";
}

/// Probability of a 1 by level; empty where the level alone does not decide it.
std::function<double(double)> share_of_ones(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                            const observer::Observer& observer) {
  session::TrialSpec trial;
  trial.procedure = spec.name;
  trial.level = 0;
  trial.deadline_s = protocol.timing.deadline_s.value_or(0);
  auto question = session::question_of(trial, protocol, 0);
  int choice = 0;
  if (question.decides == observer::Decides::right_answer) {
    if (!spec.tracks.empty()) return {};
    question.correct = 0;
  } else {
    const auto& choices = protocol.task.choices;
    const auto tracked = std::find_if(choices.begin(), choices.end(),
                                      [&](const auto& entry) { return entry.id == spec.tracks; });
    if (tracked == choices.end()) return {};
    choice = static_cast<int>(tracked - choices.begin());
  }
  return [question, choice, &observer](double level) mutable {
    question.level = level;
    return observer.share(question, choice);
  };
}

/// Probability of a 1 where steps down and up balance (Garcia-Perez 1998); equal steps give .5^(1/n).
std::optional<double> staircase_target(const procedure::Spec& spec) {
  if (spec.target) return spec.target;
  const auto& down = spec.step_down.empty() ? spec.step : spec.step_down;
  const auto& up = spec.step_up.empty() ? spec.step : spec.step_up;
  if (spec.n_up != 1 || down.empty() || up.empty()) return std::nullopt;
  return std::pow(up.back() / (up.back() + down.back()), 1.0 / spec.n_down);
}

/// Where a monotone function crosses a value between two levels; none where it does not.
std::optional<double> crossing(const std::function<double(double)>& share, double low, double high,
                               double value) {
  const bool rises = share(high) > share(low);
  const auto below = [&](double level) { return (share(level) < value) == rises; };
  if (!below(low) || below(high)) return std::nullopt;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (below(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

std::optional<double> settled_level(const protocol::Protocol& protocol, const procedure::Spec& spec,
                                    const observer::Observer& observer) {
  const auto share = share_of_ones(protocol, spec, observer);
  if (!share) return std::nullopt;
  const bool decibel = spec.level.ends_with("_dB");
  const bool two_sided = protocol.task.kind == protocol::TaskKind::single_interval;
  // Wide enough for both asymptotes whatever the unit.
  const double high = decibel ? 400 : 1e6, low = decibel ? -400 : two_sided ? -1e6 : 0;
  switch (spec.kind) {
    case Kind::constant_stimuli:
    case Kind::adjustment:
      return std::nullopt;
    case Kind::up_down:
    case Kind::weighted_up_down: {
      const auto target = staircase_target(spec);
      return target ? crossing(share, low, high, *target) : std::nullopt;
    }
    case Kind::quest_plus:
    case Kind::psi:
    case Kind::psi_marginal:
      break;
  }
  const double way = spec.function == procedure::Function::weibull ? 1 - std::exp(-1.0) : 0.5;
  return crossing(share, low, high, share(low) + way * (share(high) - share(low)));
}

void ExpectedAnswers::add(const protocol::Protocol& protocol, const session::TrialSpec& trial,
                          const observer::Question& question, const observer::Observer& observer) {
  if (trial.type != store::TrialType::experimental || !trial.level) return;
  auto& sum = sums_[{instruction_of(protocol, trial.factors), *trial.level}];
  sum.trials += 1;
  if (trial.correct) sum.correct += observer.share(question, *trial.correct);
  sum.second += observer.share(question, 1);
}

void ExpectedAnswers::add(const ExpectedAnswers& other) {
  for (const auto& [key, more] : other.sums_) {
    auto& sum = sums_[key];
    sum.trials += more.trials, sum.correct += more.correct, sum.second += more.second;
  }
}

std::optional<analysis::Psychometric> ExpectedAnswers::fit(const std::string& instruction,
                                                           const analysis::FitOptions& options,
                                                           Count count) const {
  std::vector<std::pair<double, Sum>> levels;
  double total = 0;
  for (const auto& [key, sum] : sums_)
    if (instruction.empty() || key.first == instruction)
      levels.emplace_back(key.second, sum), total += sum.trials;
  if (levels.empty()) return std::nullopt;
  const auto share = [](const Sum& sum) { return sum.second / sum.trials; };
  const bool second_rises = share(levels.back().second) >= share(levels.front().second);
  std::vector<analysis::LevelCount> counts;
  // So many answers that rounding their number does not show.
  const double scale = 1e8 / total;
  for (const auto& [level, sum] : levels) {
    const double ones = count == Count::correct ? sum.correct
                        : second_rises          ? sum.second
                                                : sum.trials - sum.second;
    counts.push_back({level, static_cast<int>(std::lround(sum.trials * scale)),
                      static_cast<int>(std::lround(ones * scale))});
  }
  return analysis::fit_psychometric(counts, options).parameters;
}

}  // namespace turnpoint::app

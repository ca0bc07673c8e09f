#include <algorithm>
#include <cmath>

#include "station/protocol/advice_list.hpp"
#include "station/text/number.hpp"

namespace turnpoint::protocol {

namespace {

using procedure::Kind;
using procedure::Spec;
using text::number;

bool depends_on(const Protocol& protocol, const std::string& level) {
  for (const auto& name : scenes_used(protocol))
    for (const auto* expression : expressions_of(protocol.scenes.at(name))) {
      double sum = 0;
      for (const auto& [factor, coefficient] : expression->terms)
        if (factor == level) sum += coefficient;
      for (const auto& product : expression->products)
        if (std::find(product.factors.begin(), product.factors.end(), level) != product.factors.end())
          return true;
      if (sum != 0) return true;
    }
  return false;
}

void check_level(AdviceList& advice, const Spec& spec) {
  if (depends_on(advice.protocol, spec.level)) return;
  const bool slider = spec.level == advice.protocol.task.adjusts;
  advice.add(slider ? "task.adjusts" : key_of(spec, "level"),
             "no scene of the task depends on \"" + spec.level + "\", so all trials are the same",
             "use a scene with \"" + spec.level + "\" in its arithmetic");
}

void check_second(AdviceList& advice, const Spec& spec) {
  if (spec.second && !depends_on(advice.protocol, spec.second->level))
    advice.add(
        key_of(spec, "second.level"),
        "no scene of the task depends on \"" + spec.second->level + "\", so the threshold cannot either",
        "use a scene with \"" + spec.second->level + "\" in its arithmetic");
}

// Reports levels that differ only by a rounding error, because they were probably meant to be the same level.
void check_values(AdviceList& advice, const Spec& spec) {
  auto values = spec.values;
  std::sort(values.begin(), values.end());
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double apart = values[i] - values[i - 1];
    if (apart > 0 && apart < 1e-6 * (values.back() - values.front()))
      return advice.add(levels_key(spec), "two levels differ by " + number(apart) + " only",
                        "list each level once, or use clearly different levels");
  }
}

void check_steps(AdviceList& advice, const Spec& spec) {
  const auto& down = spec.step.empty() ? spec.step_down : spec.step;
  const auto key = key_of(spec, spec.step.empty() ? "step_down" : "step");
  if (down.empty() || spec.scale != procedure::Scale::linear) return;
  if (spec.min && spec.max && down.front() >= *spec.max - *spec.min)
    advice.add(key, "a step of " + number(down.front()) + " is as large as the whole range",
               "use steps well below " + number(*spec.max - *spec.min));
  if (!std::is_sorted(down.rbegin(), down.rend()))
    advice.add(key, "the steps become larger from reversal to reversal",
               "use steps that become smaller, such as [4.0, 2.0, 1.0]");
}

// If wrong answers move a staircase at least as often as right answers do, it converges at a level where at
// most half of the answers are right.
void check_target(AdviceList& advice, const Spec& spec) {
  const double guessing = chance(advice.protocol);
  if (spec.target && *spec.target <= guessing + 1e-9)
    advice.add(key_of(spec, "target"),
               "a target of " + number(*spec.target, 3) + " is not higher than the accuracy of guessing",
               "between " + number(guessing, 3) + " and 1");
  const bool larger_up = !spec.step_up.empty() && spec.step_up.back() > spec.step_down.back();
  if (spec.kind == Kind::up_down && guessing > 0.4 && spec.n_down <= spec.n_up && !larger_up)
    advice.add(key_of(spec, spec.n_up > 1 ? "n_up" : "n_down"),
               "the staircase converges where at most half of the answers are right, which is no better than "
               "guessing",
               "set \"n_down\" higher than \"n_up\"");
}

void check_rates(AdviceList& advice, const Spec& spec) {
  const double guessing = chance(advice.protocol);
  if (spec.tracks.empty()) {
    check_target(advice, spec);
    for (const double guess : spec.guess.values)
      if (std::fabs(guess - guessing) > 0.1) {
        advice.add(key_of(spec, "grid.guess"),
                   "a guess rate of " + number(guess, 3) + ", but in this task guessing gets " +
                       number(guessing, 3) + " right",
                   number(guessing, 3) + ", or values near it, should be used");
        break;
      }
  }
  for (const double lapse : spec.lapse.values)
    if (lapse >= 0.5 && lapse < 1) {
      advice.add(key_of(spec, "grid.lapse"),
                 "a lapse rate of " + number(lapse, 3) + ": most answers would be lapses of attention",
                 "use small values, such as 0.01 to 0.1");
      break;
    }
}

void check_grids(AdviceList& advice, const Spec& spec) {
  const auto& stimuli = spec.stimuli.values;
  const auto& threshold = spec.threshold.values;
  if (stimuli.empty() || threshold.empty()) return;
  const auto [low, high] = std::minmax_element(stimuli.begin(), stimuli.end());
  const auto [from, to] = std::minmax_element(threshold.begin(), threshold.end());
  if (*to < *low || *from > *high)
    advice.add(key_of(spec, "grid.threshold"),
               "no threshold of the grid lies within the range of the stimuli",
               number(*low) + " to " + number(*high));
  const auto& prior = spec.prior_threshold.normal;
  if (prior && (prior->first < *from - 3 * prior->second || prior->first > *to + 3 * prior->second))
    advice.add(key_of(spec, "prior.threshold"),
               "the prior's mean of " + number(prior->first) + " is far outside the grid",
               number(*from) + " to " + number(*to));
  // On a grid, the standard deviation of the threshold can hardly become smaller than that of a uniform
  // distribution between two neighbouring points, which is their distance / sqrt(12).
  const double finest = threshold.size() < 2 ? 0 : (*to - *from) / static_cast<double>(threshold.size() - 1);
  const double least_sd = finest / std::sqrt(12.0);
  if (spec.stop.threshold_sd && spec.scale == procedure::Scale::linear && *spec.stop.threshold_sd < least_sd)
    advice.add(key_of(spec, "stop.threshold_sd"),
               "a \"threshold_sd\" of " + number(*spec.stop.threshold_sd) +
                   " is finer than the grid, whose values are " + number(finest) + " apart",
               number(least_sd, 2) + " or more is possible; otherwise use a finer \"grid.threshold\"");
}

void check_stop(AdviceList& advice, const Spec& spec) {
  const auto& stop = spec.stop;
  if (stop.min_trials && stop.trials && *stop.min_trials > *stop.trials)
    advice.add(key_of(spec, "stop"), "\"min_trials\" is larger than \"trials\"",
               "at most " + std::to_string(*stop.trials));
  if (stop.reversals && stop.trials && *stop.reversals >= *stop.trials)
    advice.add(key_of(spec, "stop"),
               std::to_string(*stop.reversals) + " reversals need more than " + std::to_string(*stop.trials) +
                   " trials, so one of the two stopping rules has no effect",
               "set fewer reversals than trials");
}

}  // namespace

std::string levels_key(const Spec& spec) {
  const bool slider = spec.kind == Kind::adjustment;
  return key_of(spec, slider || spec.start ? "start" : !spec.stimuli.values.empty() ? "stimuli" : "values");
}

double chance(const Protocol& protocol) {
  return protocol.task.choices.empty() ? 0 : 1.0 / static_cast<double>(protocol.task.choices.size());
}

void advise_on_grids(AdviceList& advice) {
  for (const auto& spec : advice.protocol.procedures) {
    check_level(advice, spec);
    check_second(advice, spec);
    check_values(advice, spec);
    check_steps(advice, spec);
    check_rates(advice, spec);
    check_grids(advice, spec);
    check_stop(advice, spec);
  }
}

}  // namespace turnpoint::protocol

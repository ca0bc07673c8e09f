#include <algorithm>
#include <cmath>

#include "station/core/number.hpp"
#include "station/protocol/advice_list.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/tasks.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

using core::number;
using procedure::Kind;
using procedure::Spec;

bool depends_on(const Linear& expression, const std::string& level) {
  double sum = 0;
  for (const auto& [factor, coefficient] : expression.terms)
    if (factor == level) sum += coefficient;
  for (const auto& product : expression.products)
    if (std::find(product.factors.begin(), product.factors.end(), level) != product.factors.end())
      return true;
  return sum != 0;
}

/// True if the level changes what the surface presents, or when.
bool depends_on(const Protocol& protocol, const std::string& level) {
  for (const auto& name : scenes_used(protocol))
    for (const auto* expression : expressions_of(protocol.scenes.at(name)))
      if (depends_on(*expression, level)) return true;
  const auto times = stimulus_times(protocol.task);
  return std::any_of(times.begin(), times.end(), [&](const Linear& time) { return depends_on(time, level); });
}

void check_level(AdviceList& advice, const Spec& spec) {
  if (depends_on(advice.protocol, spec.level)) return;
  const bool slider = spec.level == advice.protocol.task.adjusts;
  advice.add(
      slider ? key_of(advice.protocol.task, "adjusts") : key_of(spec, "level"),
      phrase("no scene of the task depends on \"%1\", so all trials are the same", {plain(spec.level)}),
      phrase("use a scene with \"%1\" in its arithmetic", {plain(spec.level)}));
}

void check_second(AdviceList& advice, const Spec& spec) {
  if (spec.second && !depends_on(advice.protocol, spec.second->level))
    advice.add(key_of(spec, "second.level"),
               phrase("no scene of the task depends on \"%1\", so the threshold cannot either",
                      {plain(spec.second->level)}),
               phrase("use a scene with \"%1\" in its arithmetic", {plain(spec.second->level)}));
}

// Reports levels that differ only by a rounding error, because they were probably meant to be the same level.
void check_values(AdviceList& advice, const Spec& spec) {
  auto values = spec.values;
  std::sort(values.begin(), values.end());
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double apart = values[i] - values[i - 1];
    if (apart > 0 && apart < 1e-6 * (values.back() - values.front()))
      return advice.add(levels_key(spec), phrase("two levels differ by %1 only", {plain(number(apart))}),
                        phrase("list each level once, or use clearly different levels"));
  }
}

void check_steps(AdviceList& advice, const Spec& spec) {
  const auto& down = spec.step.empty() ? spec.step_down : spec.step;
  const auto key = key_of(spec, spec.step.empty() ? "step_down" : "step");
  if (down.empty() || spec.scale != procedure::Scale::linear) return;
  if (spec.min && spec.max && down.front() >= *spec.max - *spec.min)
    advice.add(key, phrase("a step of %1 is as large as the whole range", {plain(number(down.front()))}),
               phrase("use steps well below %1", {plain(number(*spec.max - *spec.min))}));
  if (!std::is_sorted(down.rbegin(), down.rend()))
    advice.add(key, phrase("the steps become larger from reversal to reversal"),
               phrase("use steps that become smaller, such as %1", {plain("[4.0, 2.0, 1.0]")}));
}

// If wrong answers move a staircase at least as often as right answers do, it converges at a level where at
// most half of the answers are right.
void check_target(AdviceList& advice, const Spec& spec) {
  const double guessing = chance(advice.protocol);
  if (spec.target && *spec.target <= guessing + 1e-9)
    advice.add(key_of(spec, "target"),
               phrase("a target of %1 is not higher than the accuracy of guessing",
                      {plain(number(*spec.target, 3))}),
               phrase("between %1 and %2", {plain(number(guessing, 3)), plain("1")}));
  const bool larger_up = !spec.step_up.empty() && spec.step_up.back() > spec.step_down.back();
  if (spec.kind == Kind::up_down && guessing > 0.4 && spec.n_down <= spec.n_up && !larger_up)
    advice.add(key_of(spec, spec.n_up > 1 ? "n_up" : "n_down"),
               phrase("the staircase converges where at most half of the answers are right, which is no "
                      "better than guessing"),
               phrase("set \"n_down\" higher than \"n_up\""));
}

void check_rates(AdviceList& advice, const Spec& spec) {
  const double guessing = chance(advice.protocol);
  if (spec.tracks.empty()) {
    check_target(advice, spec);
    for (const double guess : spec.guess.values)
      if (std::fabs(guess - guessing) > 0.1) {
        advice.add(key_of(spec, "grid.guess"),
                   phrase("a guess rate of %1, but in this task guessing gets %2 right",
                          {plain(number(guess, 3)), plain(number(guessing, 3))}),
                   phrase("%1, or values near it, should be used", {plain(number(guessing, 3))}));
        break;
      }
  }
  for (const double lapse : spec.lapse.values)
    if (lapse >= 0.5 && lapse < 1) {
      advice.add(
          key_of(spec, "grid.lapse"),
          phrase("a lapse rate of %1: most answers would be lapses of attention", {plain(number(lapse, 3))}),
          phrase("use small values, such as 0.01 to 0.1"));
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
               phrase("no threshold of the grid lies within the range of the stimuli"),
               phrase("%1 to %2", {plain(number(*low)), plain(number(*high))}));
  const auto& prior = spec.prior_threshold.normal;
  if (prior && (prior->first < *from - 3 * prior->second || prior->first > *to + 3 * prior->second))
    advice.add(key_of(spec, "prior.threshold"),
               phrase("the prior's mean of %1 is far outside the grid", {plain(number(prior->first))}),
               phrase("%1 to %2", {plain(number(*from)), plain(number(*to))}));
  // On a grid, the standard deviation of the threshold can hardly become smaller than that of a uniform
  // distribution between two neighbouring points, which is their distance / sqrt(12).
  const double finest = threshold.size() < 2 ? 0 : (*to - *from) / static_cast<double>(threshold.size() - 1);
  const double least_sd = finest / std::sqrt(12.0);
  if (spec.stop.threshold_sd && spec.scale == procedure::Scale::linear && *spec.stop.threshold_sd < least_sd)
    advice.add(key_of(spec, "stop.threshold_sd"),
               phrase("a \"threshold_sd\" of %1 is finer than the grid, whose values are %2 apart",
                      {plain(number(*spec.stop.threshold_sd)), plain(number(finest))}),
               phrase("%1 or more is possible; otherwise use a finer \"grid.threshold\"",
                      {plain(number(least_sd, 2))}));
}

void check_stop(AdviceList& advice, const Spec& spec) {
  const auto& stop = spec.stop;
  if (stop.min_trials && stop.trials && *stop.min_trials > *stop.trials)
    advice.add(key_of(spec, "stop"), phrase("\"min_trials\" is larger than \"trials\""),
               phrase("at most %1", {plain(*stop.trials)}));
  if (stop.reversals && stop.trials && *stop.reversals >= *stop.trials)
    advice.add(key_of(spec, "stop"),
               phrase("%1 reversals need more than %2 trials, so one of the two stopping rules has no effect",
                      {plain(*stop.reversals), plain(*stop.trials)}),
               phrase("set fewer reversals than trials"));
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

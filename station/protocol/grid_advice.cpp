#include <algorithm>
#include <cmath>

#include "station/protocol/advice_list.hpp"
#include "station/text/number.hpp"

namespace turnpoint::protocol {

using texts::phrase, texts::plain;

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
             phrase("problem.no_scene_trials", {plain(spec.level)}),
             phrase("problem.scene_with", {plain(spec.level)}));
}

void check_second(AdviceList& advice, const Spec& spec) {
  if (spec.second && !depends_on(advice.protocol, spec.second->level))
    advice.add(key_of(spec, "second.level"),
               phrase("problem.no_scene_threshold", {plain(spec.second->level)}),
               phrase("problem.scene_with", {plain(spec.second->level)}));
}

// Reports levels that differ only by a rounding error, because they were probably meant to be the same level.
void check_values(AdviceList& advice, const Spec& spec) {
  auto values = spec.values;
  std::sort(values.begin(), values.end());
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double apart = values[i] - values[i - 1];
    if (apart > 0 && apart < 1e-6 * (values.back() - values.front()))
      return advice.add(levels_key(spec), phrase("problem.levels_close", {plain(number(apart))}),
                        phrase("problem.levels_different"));
  }
}

void check_steps(AdviceList& advice, const Spec& spec) {
  const auto& down = spec.step.empty() ? spec.step_down : spec.step;
  const auto key = key_of(spec, spec.step.empty() ? "step_down" : "step");
  if (down.empty() || spec.scale != procedure::Scale::linear) return;
  if (spec.min && spec.max && down.front() >= *spec.max - *spec.min)
    advice.add(key, phrase("problem.step_whole", {plain(number(down.front()))}),
               phrase("problem.well_below", {plain(number(*spec.max - *spec.min))}));
  if (!std::is_sorted(down.rbegin(), down.rend()))
    advice.add(key, phrase("problem.steps_grow"), phrase("problem.steps_shrink", {plain("[4.0, 2.0, 1.0]")}));
}

// If wrong answers move a staircase at least as often as right answers do, it converges at a level where at
// most half of the answers are right.
void check_target(AdviceList& advice, const Spec& spec) {
  const double guessing = chance(advice.protocol);
  if (spec.target && *spec.target <= guessing + 1e-9)
    advice.add(key_of(spec, "target"), phrase("problem.target_guessing", {plain(number(*spec.target, 3))}),
               phrase("problem.between", {plain(number(guessing, 3)), plain("1")}));
  const bool larger_up = !spec.step_up.empty() && spec.step_up.back() > spec.step_down.back();
  if (spec.kind == Kind::up_down && guessing > 0.4 && spec.n_down <= spec.n_up && !larger_up)
    advice.add(key_of(spec, spec.n_up > 1 ? "n_up" : "n_down"), phrase("problem.converges_half"),
               phrase("problem.set_n_down"));
}

void check_rates(AdviceList& advice, const Spec& spec) {
  const double guessing = chance(advice.protocol);
  if (spec.tracks.empty()) {
    check_target(advice, spec);
    for (const double guess : spec.guess.values)
      if (std::fabs(guess - guessing) > 0.1) {
        advice.add(key_of(spec, "grid.guess"),
                   phrase("problem.guess_rate", {plain(number(guess, 3)), plain(number(guessing, 3))}),
                   phrase("problem.values_near", {plain(number(guessing, 3))}));
        break;
      }
  }
  for (const double lapse : spec.lapse.values)
    if (lapse >= 0.5 && lapse < 1) {
      advice.add(key_of(spec, "grid.lapse"), phrase("problem.lapse_rate", {plain(number(lapse, 3))}),
                 phrase("problem.small_lapse"));
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
    advice.add(key_of(spec, "grid.threshold"), phrase("problem.threshold_beyond"),
               phrase("problem.to", {plain(number(*low)), plain(number(*high))}));
  const auto& prior = spec.prior_threshold.normal;
  if (prior && (prior->first < *from - 3 * prior->second || prior->first > *to + 3 * prior->second))
    advice.add(key_of(spec, "prior.threshold"),
               phrase("problem.prior_outside", {plain(number(prior->first))}),
               phrase("problem.to", {plain(number(*from)), plain(number(*to))}));
  // On a grid, the standard deviation of the threshold can hardly become smaller than that of a uniform
  // distribution between two neighbouring points, which is their distance / sqrt(12).
  const double finest = threshold.size() < 2 ? 0 : (*to - *from) / static_cast<double>(threshold.size() - 1);
  const double least_sd = finest / std::sqrt(12.0);
  if (spec.stop.threshold_sd && spec.scale == procedure::Scale::linear && *spec.stop.threshold_sd < least_sd)
    advice.add(key_of(spec, "stop.threshold_sd"),
               phrase("problem.sd_finer", {plain(number(*spec.stop.threshold_sd)), plain(number(finest))}),
               phrase("problem.sd_possible", {plain(number(least_sd, 2))}));
}

void check_stop(AdviceList& advice, const Spec& spec) {
  const auto& stop = spec.stop;
  if (stop.min_trials && stop.trials && *stop.min_trials > *stop.trials)
    advice.add(key_of(spec, "stop"), phrase("problem.min_trials"),
               phrase("problem.at_most", {plain(*stop.trials)}));
  if (stop.reversals && stop.trials && *stop.reversals >= *stop.trials)
    advice.add(key_of(spec, "stop"),
               phrase("problem.reversals_need", {plain(*stop.reversals), plain(*stop.trials)}),
               phrase("problem.fewer_reversals"));
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

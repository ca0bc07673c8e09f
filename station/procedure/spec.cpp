#include "station/procedure/spec.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace turnpoint::procedure {

namespace {

constexpr std::array<std::pair<Kind, const char*>, 7> kKinds{{{Kind::constant_stimuli, "constant-stimuli"},
                                                              {Kind::up_down, "up-down"},
                                                              {Kind::weighted_up_down, "weighted-up-down"},
                                                              {Kind::quest_plus, "quest-plus"},
                                                              {Kind::psi, "psi"},
                                                              {Kind::psi_marginal, "psi-marginal"},
                                                              {Kind::adjustment, "adjustment"}}};

bool positive(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return v > 0 && std::isfinite(v); });
}

void validate_staircase(const Spec& spec, std::vector<Fault>& faults) {
  if (!spec.start) faults.push_back({"start", "missing", "the first level, a number"});
  if (spec.step.empty() && spec.step_down.empty() && spec.step_up.empty())
    faults.push_back({"step_down", "missing", "one or more steps above 0"});
  if (!positive(spec.step) || !positive(spec.step_down) || !positive(spec.step_up))
    faults.push_back({"step_down", "a step is not above 0", "steps above 0"});
  if (spec.min && spec.max && *spec.min >= *spec.max) faults.push_back({"min", "not below max", "min < max"});
  if (spec.start && ((spec.min && *spec.start < *spec.min) || (spec.max && *spec.start > *spec.max)))
    faults.push_back({"start", "outside min ... max", "a level between min and max"});
  if (spec.scale != Scale::linear && spec.start && !(*spec.start > 0))
    faults.push_back({"start", "not above 0 on a logarithmic scale", "a level above 0"});
  if (spec.kind == Kind::weighted_up_down && (!spec.target || !(*spec.target > 0 && *spec.target < 1)))
    faults.push_back({"target", "missing or outside (0, 1)", "a probability between 0 and 1"});
  if (spec.kind == Kind::up_down && (spec.n_down < 1 || spec.n_up < 1))
    faults.push_back({"n_down", "below 1", "whole numbers of 1 or more"});
  if (spec.kind == Kind::up_down && spec.step.empty() && (spec.step_down.empty() || spec.step_up.empty()))
    faults.push_back({"step", "missing for one direction", "step, or both step_down and step_up"});
  if (!spec.stop.trials && !spec.stop.reversals)
    faults.push_back({"stop", "nothing stops it", "trials or reversals"});
  if (spec.discard_reversals < 0 || (spec.stop.reversals && spec.stop.rule == StopRule::any &&
                                     spec.discard_reversals + 2 > *spec.stop.reversals))
    faults.push_back({"discard_reversals", "leaves fewer than two reversals to average",
                      "at least two fewer than the reversals at which the staircase stops"});
}

void validate_rate(const char* key, const Grid& grid, std::vector<Fault>& faults) {
  for (const double rate : grid.values)
    if (!(rate >= 0 && rate < 1))
      return faults.push_back({key, "a rate outside 0 to 1", "probabilities from 0 up to, but not, 1"});
}

void validate_prior(const char* key, const Prior& prior, const Grid& grid, std::vector<Fault>& faults) {
  if (prior.weights.empty()) return;
  const auto values = grid.values.size();
  if (prior.weights.size() != values)
    faults.push_back({key, std::to_string(prior.weights.size()) + " weights",
                      "as many as \"grid\" has values: " + std::to_string(values)});
  else if (std::none_of(prior.weights.begin(), prior.weights.end(), [](double w) { return w > 0; }))
    faults.push_back({key, "all weights are 0", "at least one above 0"});
}

void validate_posterior(const Spec& spec, std::vector<Fault>& faults) {
  if (spec.stimuli.values.empty()) faults.push_back({"stimuli", "missing", "the levels to choose from"});
  if (spec.threshold.values.empty()) faults.push_back({"grid.threshold", "missing", "its values"});
  if (spec.slope.values.empty()) faults.push_back({"grid.slope", "missing", "its values"});
  if (!positive(spec.slope.values)) faults.push_back({"grid.slope", "a slope is not above 0", "above 0"});
  validate_rate("grid.guess", spec.guess, faults);
  validate_rate("grid.lapse", spec.lapse, faults);
  validate_prior("prior.threshold", spec.prior_threshold, spec.threshold, faults);
  validate_prior("prior.slope", spec.prior_slope, spec.slope, faults);
  validate_prior("prior.guess", spec.prior_guess, spec.guess, faults);
  validate_prior("prior.lapse", spec.prior_lapse, spec.lapse, faults);
  // What one trial has to look through: some seconds on a small computer.
  constexpr double most = 5e7;
  double size = static_cast<double>(spec.stimuli.values.size());
  for (const auto* grid : {&spec.threshold, &spec.slope, &spec.guess, &spec.lapse})
    size *= static_cast<double>(std::max<std::size_t>(1, grid->values.size()));
  if (size > most)
    faults.push_back({"grid.threshold", "stimuli and grids have too many combinations to choose in time",
                      "at most 50 million"});
  if (!spec.stop.trials && !spec.stop.threshold_sd && !spec.stop.entropy_nats)
    faults.push_back({"stop", "nothing stops it", "trials or threshold_sd"});
}

}  // namespace

const char* name(Kind kind) {
  for (const auto& [k, text] : kKinds)
    if (k == kind) return text;
  return "";
}

std::optional<Kind> parse_kind(const std::string& text) {
  for (const auto& [k, name] : kKinds)
    if (text == name) return k;
  return std::nullopt;
}

std::vector<std::string> kind_names() {
  std::vector<std::string> names;
  for (const auto& [k, name] : kKinds) names.emplace_back(name);
  return names;
}

std::vector<Fault> validate(const Spec& spec) {
  std::vector<Fault> faults;
  if (spec.level.empty()) faults.push_back({"level", "missing", "the name of a factor"});
  switch (spec.kind) {
    case Kind::constant_stimuli:
      if (spec.values.empty()) faults.push_back({"values", "missing", "one or more levels"});
      if (spec.repeats < 1) faults.push_back({"repeats", "below 1", "a whole number of 1 or more"});
      if (spec.max_run && *spec.max_run < 1) faults.push_back({"order.max_run", "below 1", "1 or more"});
      break;
    case Kind::up_down:
    case Kind::weighted_up_down:
      validate_staircase(spec, faults);
      break;
    case Kind::quest_plus:
    case Kind::psi:
    case Kind::psi_marginal:
      validate_posterior(spec, faults);
      break;
    case Kind::adjustment:
      if (spec.values.empty()) faults.push_back({"start", "missing", "one or more levels to start from"});
      if (spec.repeats < 1) faults.push_back({"repeats", "below 1", "a whole number of 1 or more"});
      break;
  }
  return faults;
}

std::vector<Fault> advise(const Spec& spec) {
  std::vector<Fault> advice;
  if (spec.stimuli.values.size() == 1)
    advice.push_back({"stimuli", "a grid of one point", "two or more, to have something to choose"});
  if (spec.threshold.values.size() == 1)
    advice.push_back({"grid.threshold", "a grid of one point: nothing is left to find", "two or more"});
  const auto left_out = [&](const char* key) {
    return std::find(spec.nuisance.begin(), spec.nuisance.end(), key) != spec.nuisance.end();
  };
  if (!spec.nuisance.empty() && spec.kind != Kind::psi_marginal)
    advice.push_back({"nuisance", "has no effect on this kind", "kind = \"psi-marginal\""});
  else if (left_out("threshold") && left_out("slope"))
    advice.push_back({"nuisance", "no trial is spent on anything", "\"threshold\" or \"slope\" left out"});
  if (spec.start && (spec.stop.threshold_sd || spec.stop.entropy_nats))
    advice.push_back(
        {"stop", "a staircase ends by trials and reversals alone", "\"trials\" or \"reversals\""});
  if (!spec.stimuli.values.empty() && spec.stop.reversals)
    advice.push_back(
        {"stop", "there are no reversals without a staircase", "\"trials\" or \"threshold_sd\""});
  if (spec.lapse.values.size() == 1 && spec.lapse.values[0] == 0)
    advice.push_back(
        {"grid.lapse", "only 0: one slip counts as impossible", "a value above 0, such as 0.02"});
  return advice;
}

}  // namespace turnpoint::procedure

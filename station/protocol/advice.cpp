#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "station/protocol/combinations.hpp"
#include "station/protocol/expression.hpp"
#include "station/protocol/survey.hpp"
#include "station/text/number.hpp"

namespace turnpoint::protocol {

namespace {

using text::number;
using text::Problem;

// Just noticeable Weber fractions of friction are reported between 0.11
// (Gueorguiev et al. 2017) and 0.2 (Fehlberg et al. 2022); above the larger one
// everybody feels the difference.
constexpr double felt_by_all = 0.2;

Place place_of(const Protocol& protocol, const procedure::Spec& spec) {
  const auto found = protocol.procedure_places.find(spec.name);
  return found == protocol.procedure_places.end() ? Place{protocol.path, 0, 0} : found->second;
}

// By how much the scene's boundary (mm) and zone friction change for one unit
// of the factor.
double coefficient(const std::optional<Linear>& expression, const std::string& factor) {
  if (!expression || expression->absolute) return 0;
  for (const auto& [name, value] : expression->terms)
    if (name == factor) return std::fabs(value);
  return 0;
}

double smallest(const std::vector<double>& levels) {
  double least = 0;
  for (const double level : levels)
    if (level != 0 && (least == 0 || std::fabs(level) < least)) least = std::fabs(level);
  return least;
}

// A level must stand out from what the planner may get wrong: four times the
// tolerance.
void check_fineness(const Protocol& protocol, const procedure::Spec& spec, std::vector<Problem>& advice) {
  const bool fixed_levels = spec.kind == procedure::Kind::constant_stimuli;
  const double level = smallest(spec.values);
  if (!fixed_levels || level == 0) return;
  for (const auto& name : scenes_used(protocol)) {
    const auto& scene = protocol.scenes.at(name);
    const double boundary_mm = level * coefficient(scene.boundary_mm, spec.level);
    const double friction = scene.zone ? level * coefficient(scene.zone->friction, spec.level) : 0;
    const auto tell = [&](double step, double tolerance, const std::string& unit) {
      if (step > 0 && step < 4 * tolerance * (1 - 1e-9))
        advice.push_back({place_of(protocol, spec),
                          "the smallest level of \"" + spec.name + "\" moves scene \"" + name + "\" by " +
                              number(step) + unit + ", and its tolerance is " + number(tolerance) + unit,
                          "levels of four times the tolerance or more"});
    };
    tell(boundary_mm, scene.tolerance.boundary_mm.value_or(0), " mm");
    tell(friction, scene.tolerance.friction.value_or(0), " of friction");
  }
}

// A threshold cannot be found among levels that everybody feels.
void check_coarseness(const Protocol& protocol, const procedure::Spec& spec, std::vector<Problem>& advice) {
  auto levels = spec.values;
  levels.insert(levels.end(), spec.stimuli.values.begin(), spec.stimuli.values.end());
  if (spec.min) levels.push_back(*spec.min);
  if (levels.empty()) return;
  const auto tell = [&](double fraction) {
    if (fraction > felt_by_all)
      advice.push_back({place_of(protocol, spec),
                        "the smallest level of \"" + spec.name + "\" is a friction difference of " +
                            number(100 * fraction, 3) + " %, which everybody feels",
                        "levels down to a Weber fraction of 0.1 or less (-20 dB)"});
  };
  for (const auto& name : scenes_used(protocol)) {
    const auto& scene = protocol.scenes.at(name);
    if (coefficient(scene.friction_contrast_dB, spec.level) == 1)
      return tell(std::pow(10.0, *std::min_element(levels.begin(), levels.end()) / 20));
    const double slope = scene.zone ? coefficient(scene.zone->friction, spec.level) : 0;
    if (slope > 0 && !spec.values.empty() && scene.zone->friction->constant > 0)
      return tell(smallest(levels) * slope / scene.zone->friction->constant);
  }
}

// Where both staircase steps are stated, a run settles where p(down) times the
// step down equals p(up) times the step up (Kaernbach 1991, generalised by
// Garcia-Perez 1998).
void check_steps(const Protocol& protocol, const procedure::Spec& spec, std::vector<Problem>& advice) {
  if (spec.kind != procedure::Kind::up_down || spec.step_down.empty() || spec.step_up.empty()) return;
  const double down = spec.step_down.back(), up = spec.step_up.back();
  if (down == up) return;
  const double target = std::pow(up / (up + down), 1.0 / spec.n_down);
  advice.push_back({place_of(protocol, spec),
                    "the unequal steps of \"" + spec.name + "\" make it settle near " +
                        number(100 * target, 3) + " % right",
                    "equal steps settle at " + number(100 * std::pow(0.5, 1.0 / spec.n_down), 4) + " %"});
}

// The share of practice trials that one key, always pressed, gets right.
double one_key_share(const Protocol& protocol, const Block& block) {
  const auto& task = protocol.task;
  if (task.kind == TaskKind::oddity) return 1.0 / 3;
  if (task.kind != TaskKind::single_interval) return 0.5;
  std::map<std::string, double> right;
  double all = 0;
  for (const double level : block.levels) {
    auto factors = any_factors(protocol);
    factors[block.level] = level;
    ++all;
    for (const auto& [id, comparison] : task.correct_answer)
      if (holds(comparison, factors)) right[id] += 1;
  }
  double most = 0;
  for (const auto& [id, count] : right) most = std::max(most, count);
  return all > 0 ? most / all : 0.5;
}

// The ends of the factor's range, which are its easiest levels.
std::string easy_on_both_sides(const Protocol& protocol, const std::string& name) {
  const auto* factor = find_factor(protocol.factors, name);
  if (!factor || !factor->range) return "easy levels for each answer";
  return "easy levels for each answer, such as " + name + " = [" + number(factor->range->first) + ", " +
         number(factor->range->second) + "]";
}

void check_practice(const Protocol& protocol, const Block& block, std::vector<Problem>& advice) {
  const auto& task = protocol.task;
  if (block.pass && one_key_share(protocol, block) >= block.pass->accuracy)
    advice.push_back({block.place,
                      "practice \"" + block.name + "\" is passed by one key, always pressed (" +
                          number(100 * one_key_share(protocol, block), 3) + " % right)",
                      "levels with each answer right equally often, and an "
                      "accuracy above that"});
  const bool one_sided_catch = block.catch_trials && task.kind == TaskKind::single_interval && [&] {
    std::set<std::string> right;
    for (const double level : block.catch_trials->levels) {
      auto factors = any_factors(protocol);
      factors[block.catch_trials->factor] = level;
      for (const auto& [id, comparison] : task.correct_answer)
        if (holds(comparison, factors)) right.insert(id);
    }
    return !task.correct_answer.empty() && right.size() < 2;
  }();
  if (one_sided_catch)
    advice.push_back({block.place, "the catch trials of \"" + block.name + "\" have one right answer only",
                      easy_on_both_sides(protocol, block.catch_trials->factor)});
}

void check_unused(const Protocol& protocol, std::vector<Problem>& advice) {
  const auto used = factors_used(protocol);
  const auto sources = sources_of(protocol);
  for (const auto& factor : protocol.factors) {
    const auto sets = [&](const Source& source) { return source.sets.count(factor.name) > 0; };
    if (!used.count(factor.name) && std::none_of(sources.begin(), sources.end(), sets))
      advice.push_back({factor.place, "the factor \"" + factor.name + "\" is not used", ""});
  }
  const auto scenes = scenes_used(protocol);
  for (const auto& [name, scene] : protocol.scenes) {
    const auto is_base = [&, base = name](const auto& other) { return other.second.base == base; };
    if (std::find(scenes.begin(), scenes.end(), name) == scenes.end() &&
        std::none_of(protocol.scenes.begin(), protocol.scenes.end(), is_base))
      advice.push_back({scene.place, "the scene \"" + name + "\" is not used", ""});
  }
  for (const auto& spec : protocol.procedures) {
    const auto runs = [&](const Source& source) { return source.spec == &spec; };
    if (std::none_of(sources.begin(), sources.end(), runs))
      advice.push_back({place_of(protocol, spec), "the procedure \"" + spec.name + "\" is in no block", ""});
  }
}

}  // namespace

std::vector<text::Problem> advice(const Protocol& protocol) {
  std::vector<Problem> advice;
  for (const auto& spec : protocol.procedures) {
    for (const auto& fault : procedure::advise(spec))
      advice.push_back({place_of(protocol, spec),
                        "procedure \"" + spec.name + "\": " + fault.key + ": " + fault.what, fault.allowed});
    check_fineness(protocol, spec, advice);
    check_coarseness(protocol, spec, advice);
    check_steps(protocol, spec, advice);
  }
  for (const auto& part : protocol.plan) check_practice(protocol, block_of(part), advice);
  check_unused(protocol, advice);
  return advice;
}

}  // namespace turnpoint::protocol

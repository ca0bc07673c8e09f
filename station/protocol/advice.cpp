#include <algorithm>
#include <cmath>

#include "station/core/number.hpp"
#include "station/protocol/advice_list.hpp"
#include "station/protocol/sources.hpp"
#include "station/protocol/survey.hpp"
#include "station/protocol/tasks.hpp"
#include "station/protocol/visits.hpp"

namespace turnpoint::protocol {

using core::phrase, core::plain;

namespace {

using core::number;

// Published just noticeable differences of friction range from a Weber fraction of 0.11 (Gueorguiev et al.
// 2017) to 0.2 (Fehlberg et al. 2022). The advice assumes that everybody feels more than 0.2.
constexpr double felt_by_all = 0.2;

// How much the value of this expression (for example, a boundary in mm) changes per unit of the factor.
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

double largest(const std::vector<double>& levels) {
  double most = 0;
  for (const double level : levels) most = std::max(most, std::fabs(level));
  return most;
}

// The smallest level must change the scene by at least four times the scene's tolerance, which is the error
// that the planner may make. If even the largest level changes it by less, the advice is about the tolerance
// instead of the levels.
void check_fineness(AdviceList& advice, const procedure::Spec& spec) {
  if (spec.kind != procedure::Kind::constant_stimuli || smallest(spec.values) == 0) return;
  for (const auto& name : scenes_used(advice.protocol)) {
    const auto& scene = advice.protocol.scenes.at(name);
    const auto tell = [&](double per_unit, double tolerance, const char* key) {
      const double step = smallest(spec.values) * per_unit, enough = 4 * tolerance * (1 - 1e-9);
      if (step > 0 && step < enough)
        advice.add(
            largest(spec.values) * per_unit < enough ? "scene." + name + ".tolerance"
                                                     : key_of(spec, "values"),
            phrase(key, {plain(spec.name), plain(name), plain(number(step)), plain(number(tolerance))}),
            phrase("use levels of at least four times the tolerance"));
    };
    tell(coefficient(scene.boundary_mm, spec.level), scene.tolerance.boundary_mm.value_or(0),
         "the smallest level of \"%1\" moves scene \"%2\" by %3 mm, but the scene's tolerance is %4 mm");
    if (scene.zone)
      tell(coefficient(scene.zone->friction, spec.level), scene.tolerance.friction.value_or(0),
           "the smallest level of \"%1\" moves scene \"%2\" by %3 of friction, but the scene's tolerance is "
           "%4 of friction");
  }
}

// Reports levels that are all so large that everybody feels them: no threshold can be found then. A procedure
// that ends at a criterion (stop.right) is for training and looks for no threshold.
void check_coarseness(AdviceList& advice, const procedure::Spec& spec) {
  // a stimulus of a comparison need not be hard to tell from the plain surface
  if (spec.stop.right || spec.kind == procedure::Kind::comparisons) return;
  auto levels = spec.values;
  levels.insert(levels.end(), spec.stimuli.values.begin(), spec.stimuli.values.end());
  if (spec.min) levels.push_back(*spec.min);
  if (levels.empty()) return;
  const auto tell = [&](double fraction) {
    if (fraction > felt_by_all)
      advice.add(
          "procedure." + spec.name,
          phrase("the smallest level of \"%1\" is a friction difference of %2 %, which everybody feels",
                 {plain(spec.name), plain(number(100 * fraction, 3))}),
          phrase("add levels down to a Weber fraction of 0.1 or less (-20 dB)"));
  };
  for (const auto& name : scenes_used(advice.protocol)) {
    const auto& scene = advice.protocol.scenes.at(name);
    if (coefficient(scene.friction_contrast_dB, spec.level) == 1)
      return tell(std::pow(10.0, *std::min_element(levels.begin(), levels.end()) / 20));
    const double slope = scene.zone ? coefficient(scene.zone->friction, spec.level) : 0;
    if (slope > 0 && !spec.values.empty() && scene.zone->friction->constant > 0)
      return tell(smallest(levels) * slope / scene.zone->friction->constant);
  }
}

// With unequal steps, a staircase converges where P(step down) * size of a step down = P(step up) * size of a
// step up (Kaernbach 1991, generalised by Garcia-Perez 1998).
void check_unequal_steps(AdviceList& advice, const procedure::Spec& spec) {
  if (spec.kind != procedure::Kind::up_down || spec.step_down.empty() || spec.step_up.empty()) return;
  const double down = spec.step_down.back(), up = spec.step_up.back();
  if (down == up) return;
  const double target = std::pow(up / (up + down), 1.0 / spec.n_down);
  advice.add(key_of(spec, "step_up"),
             phrase("the unequal steps of \"%1\" let it converge near %2 % right",
                    {plain(spec.name), plain(number(100 * target, 3))}),
             phrase("with equal steps it would converge at %1 %",
                    {plain(number(100 * std::pow(0.5, 1.0 / spec.n_down), 4))}));
}

// Reports stimuli of triads or quadruples of which one difference is always the larger one, if friction feels
// like its amplitude: answers that never disagree about it determine no scale.
void check_differences(AdviceList& advice, const procedure::Spec& spec) {
  if (spec.kind != procedure::Kind::comparisons || spec.against.size() < 2) return;
  auto felt = spec.values;
  std::ranges::sort(felt);
  if (spec.level.ends_with("_dB"))
    for (auto& level : felt) level = std::pow(10.0, level / 20);
  const std::size_t between = spec.against.size() == 2 ? 0 : 1;  // a triad shares its middle stimulus
  bool upper = true, lower = true;
  for (std::size_t a = 0; a < felt.size(); ++a)
    for (std::size_t b = a + 1; b < felt.size(); ++b)
      for (std::size_t c = b + between; c < (between == 0 ? b + 1 : felt.size()); ++c)
        for (std::size_t d = c + 1; d < felt.size(); ++d) {
          const double more = (felt[d] - felt[c]) - (felt[b] - felt[a]);
          upper = upper && more > 0, lower = lower && more < 0;
        }
  if (upper || lower)
    advice.add(key_of(spec, "values"),
               phrase("\"%1\": if friction feels like its amplitude, one difference of each comparison is "
                      "always the larger one, and there is no scale",
                      {plain(spec.name)}),
               phrase("choose values closer to equal steps of feeling"));
}

/// Looks at all tasks together.
void check_unused(AdviceList& advice) {
  const auto& protocol = advice.protocol;
  auto used = factors_used(protocol);
  for (const auto* one : tasks_of(protocol)) used.insert(one->task.question_shows);
  const auto sources = sources_of(protocol);
  for (const auto& factor : protocol.factors) {
    const auto sets = [&](const Source& source) { return source.sets.count(factor.name) > 0; };
    // a factor that divides participants into groups need not change what the surface presents
    if (!is_group(factor) && !used.count(factor.name) && std::none_of(sources.begin(), sources.end(), sets))
      advice.add("factor." + factor.name + ".name",
                 phrase("the factor \"%1\" is not used", {plain(factor.name)}));
  }
  auto scenes = scenes_used(protocol);
  for (const auto& interlude : protocol.interludes)
    for (const auto& page : interlude.pages)
      for (const auto& example : page.examples) scenes.push_back(example.scene);
  for (const auto& part : protocol.plan) scenes.push_back(block_of(part).strokes.scene);
  for (const auto& [name, scene] : protocol.scenes) {
    const auto is_base = [&, base = name](const auto& other) { return other.second.base == base; };
    if (std::find(scenes.begin(), scenes.end(), name) == scenes.end() &&
        std::none_of(protocol.scenes.begin(), protocol.scenes.end(), is_base))
      advice.add("scene." + name, phrase("the scene \"%1\" is not used", {plain(name)}));
  }
  for (const auto& spec : protocol.procedures) {
    const auto runs = [&](const Source& source) { return source.spec == &spec; };
    if (std::none_of(sources.begin(), sources.end(), runs))
      advice.add(key_of(spec, "name"),
                 phrase("the procedure \"%1\" is not used in any block", {plain(spec.name)}));
  }
}

}  // namespace

std::string key_of(const std::variant<Block, Sequence>& part, const std::string& key) {
  const auto* sequence = std::get_if<Sequence>(&part);
  return (sequence ? "sequence." + sequence->name + ".block." : "block." + block_of(part).name + ".") + key;
}

void advise_on_levels(AdviceList& advice) {
  for (const auto& spec : advice.protocol.procedures) {
    check_fineness(advice, spec);
    check_coarseness(advice, spec);
    check_unequal_steps(advice, spec);
    check_differences(advice, spec);
  }
}

namespace {

/// Advice on the protocol as one of its tasks sees it.
std::vector<core::Problem> advice_on_task(const Protocol& protocol) {
  AdviceList advice(protocol);
  for (const auto& spec : protocol.procedures)
    for (const auto& fault : procedure::advise(spec))
      advice.add(key_of(spec, fault.key), phrase("procedure \"%1\": %2", {plain(spec.name), fault.what}),
                 fault.allowed);
  advise_on_levels(advice);
  if (protocol.task.name.empty()) check_unused(advice);
  advise_on_answers(advice);
  advise_on_times(advice);
  advise_on_grids(advice);
  advise_on_plan(advice);
  advise_on_labels(advice);
  if (protocol.task.name.empty()) advise_on_interludes(advice);
  return std::move(advice.found);
}

}  // namespace

std::vector<core::Problem> advice(const Protocol& protocol) {
  if (protocol.by_task.empty()) return advice_on_task(protocol);
  AdviceList whole(protocol);
  check_unused(whole);
  advise_on_plan(whole);
  advise_on_interludes(whole);
  auto all = std::move(whole.found);
  for (const auto& one : protocol.by_task)
    for (auto& found : advice_on_task(one)) add_once(std::move(found), all);
  return all;
}

}  // namespace turnpoint::protocol

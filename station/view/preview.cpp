#include "station/view/preview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "physics/edge.hpp"
#include "physics/surface.hpp"
#include "station/core/number.hpp"
#include "station/core/usage_error.hpp"
#include "station/protocol/answers.hpp"
#include "station/protocol/combinations.hpp"
#include "station/protocol/resolve.hpp"
#include "station/protocol/tasks.hpp"

namespace turnpoint::view {

namespace {

using core::number;
using core::Phrase, core::phrase, core::plain;

protocol::FactorValue first_value(const protocol::Factor& factor) {
  if (!factor.levels.empty()) return factor.levels.front();
  if (factor.range) return 0.5 * (factor.range->first + factor.range->second);
  return 0.0;
}

Phrase shown(double value, int digits) { return plain(number(value, digits)); }

Phrase in_mm(const std::optional<double>& value_m, int digits = 5) {
  return value_m ? plain(number(1e3 * *value_m, digits) + " mm") : phrase("preview.none");
}

Phrase um(double value_m) { return plain(number(1e6 * value_m, 3) + " \u00b5m"); }

std::optional<Knob> knob_of(const protocol::Factor& factor) {
  Knob knob;
  knob.name = factor.name;
  for (const auto& level : factor.levels) {
    const auto* value = std::get_if<double>(&level);
    if (value == nullptr) return std::nullopt;
    knob.levels.push_back(*value);
  }
  std::sort(knob.levels.begin(), knob.levels.end());
  if (!knob.levels.empty()) {
    knob.low = knob.levels.front(), knob.high = knob.levels.back();
  } else if (factor.range) {
    std::tie(knob.low, knob.high) = *factor.range;
  } else {
    return std::nullopt;
  }
  knob.value = std::get<double>(first_value(factor));
  return knob;
}

void describe_plan(SceneLook& look) {
  const auto& plan = look.plan;
  const auto add = [&look](const char* label, Phrase value) {
    look.facts.emplace_back(phrase(label), std::move(value));
  };
  add("preview.boundary",
      {"", "", {in_mm(plan.boundary_m), plain(" (" + physics::format(plan.scene.edge) + ")")}});
  add("preview.model", plain(std::string(physics::name(plan.model))));
  add("preview.error", phrase(plan.inside_tolerance ? "preview.at_most_mm" : "preview.beyond_tolerance",
                              {shown(1e3 * plan.error_bound_m, 3)}));
  if (!plan.cheaper.empty()) add("preview.cheaper", plan.cheaper);
  Phrase uncertain{"", "", {phrase("preview.mm_sd", {shown(1e3 * plan.uncertainty_m, 3)})}};
  if (look.under.level) {
    uncertain.values.push_back(plain("; "));
    uncertain.values.push_back(
        phrase("preview.level_sd", {shown(look.under.level->total_dB, 2), shown(look.under.friction_low, 3),
                                    shown(look.under.friction_high, 3)}));
  }
  add("preview.uncertain", std::move(uncertain));
  for (const auto& tone : plan.tones)
    add("preview.tone",
        phrase("preview.tone_drive", {shown(1e-3 * tone.frequency_Hz, 6), um(tone.amplitude_m),
                                      plain(tone.transducer), shown(100 * tone.full_scale, 3)}));
  if (plan.zone_friction)
    add("preview.zone", phrase("preview.zone_friction",
                               {shown(*plan.zone_friction, 3), shown(plan.residual.value_or(0), 2)}));
  add("preview.surface",
      phrase("preview.crest", {um(plan.peak_displacement_m), shown(plan.crest_factor, 3)}));
  add("preview.lowest_friction", phrase("preview.of_rest", {shown(plan.lowest_friction, 3)}));
  if (plan.follow) {
    const auto figures = scene::follow_figures(plan);
    add("preview.follow", phrase("preview.follow_delay", {shown(1e3 * figures.delay.total_s, 3),
                                                          shown(1e3 * figures.time_constant_s, 3)}));
    for (const auto& texture : figures.textures)
      add("preview.texture",
          phrase("preview.texture_limits",
                 {plain(texture.part + 1), shown(texture.bandwidth_Hz, 3),
                  texture.most_speed_m_s ? plain(number(1e3 * *texture.most_speed_m_s, 3) + " mm/s")
                                         : phrase("preview.none")}));
    for (const auto& unmet : figures.unmet) add("preview.unmet", scene::in_words(plan, unmet));
  }
  for (const auto& product : plan.audible_products)
    add("preview.product",
        phrase("preview.product_order", {shown(product.frequency_Hz, 5), plain(product.order)}));
  for (const auto& warning : plan.warnings) add("preview.warning", rig::phrase_of(warning));
}

void describe_cues(SceneLook& look) {
  const auto& cues = look.plan.cues;
  const bool heard = cues.pitch_Hz > 0;
  look.cues = {{phrase("preview.pitch"),
                heard ? plain(number(cues.pitch_Hz, 5) + " Hz") : phrase("preview.inaudible")},
               {phrase("preview.loudness"),
                heard ? plain(number(cues.loudness_dB, 3) + " dB re 1 \u00b5m") : phrase("preview.silent")},
               {phrase("preview.amplitude"), um(cues.wide_end_amplitude_m)},
               {phrase("preview.stripes"), phrase("preview.apart", {in_mm(cues.stripe_pitch_m, 3)})},
               {phrase("preview.edge"), in_mm(cues.edge_width_m, 3)},
               {phrase("preview.width"), in_mm(cues.strip_width_m, 3)},
               {phrase("preview.last_maximum"), um(cues.displacement_m)}};
}

}  // namespace

Preview::Preview(protocol::Protocol protocol, rig::Rig rig)
    : protocol_(std::move(protocol)), rig_(std::move(rig)), planner_(rig_) {}

std::vector<std::string> Preview::scenes() const {
  std::vector<std::string> used, others;
  for (const auto& [name, scene] : protocol_.scenes) {
    std::vector<protocol::Part> parts;
    for (const auto* one : protocol::tasks_of(protocol_))
      for (auto& part : protocol::parts_of(one->task)) parts.push_back(std::move(part));
    const bool shown = std::any_of(parts.begin(), parts.end(), [&, scene_name = name](const auto& part) {
      return std::find(part.scenes.begin(), part.scenes.end(), scene_name) != part.scenes.end();
    });
    (shown ? used : others).push_back(name);
  }
  used.insert(used.end(), others.begin(), others.end());
  return used;
}

std::vector<Knob> Preview::knobs(const std::string& scene) const {
  auto needed = protocol::factors_of(protocol_.scenes.at(scene));
  if (const auto& base = protocol_.scenes.at(scene).base; !base.empty())
    needed.merge(protocol::factors_of(protocol_.scenes.at(base)));
  std::vector<Knob> knobs;
  for (const auto& factor : protocol_.factors)
    if (needed.count(factor.name))
      if (auto knob = knob_of(factor)) knobs.push_back(std::move(*knob));
  return knobs;
}

SceneLook Preview::look(const std::string& scene, const protocol::Factors& factors) {
  SceneLook look;
  look.scene = scene;
  look.factors = factors;
  if (!protocol_.scenes.count(scene))
    throw std::out_of_range("the protocol has no scene named \"" + scene + "\"");
  try {
    return look_at(planner_.plan(protocol::resolve(protocol_, scene, factors, 0)), factors, planner_);
  } catch (const scene::Unreachable& error) {
    look.problem = error.what();
  }
  return look;
}

protocol::Factors factors_for(const protocol::Protocol& protocol, const std::vector<std::string>& set,
                              std::vector<std::string>& assumed) {
  protocol::Factors factors;
  for (const auto& factor : protocol.factors) {
    if (!factor.levels.empty() || factor.range) factors[factor.name] = first_value(factor);
    assumed.push_back(factor.name);
  }
  for (const auto& text : set) {
    const auto equals = text.find('=');
    const auto name = text.substr(0, equals);
    const auto found = factors.find(name);
    if (equals == std::string::npos || found == factors.end()) {
      std::string known;
      for (const auto& [factor, value] : factors) known += (known.empty() ? "" : ", ") + factor;
      throw core::UsageError(
          fmt::format("--set {}: write factor=value, with one of the factors {}", text, known));
    }
    const auto value = text.substr(equals + 1);
    if (std::holds_alternative<double>(found->second)) {
      const auto number = core::read_number(value);
      if (!number || !std::isfinite(*number))
        throw core::UsageError(fmt::format("--set {}: the value of {} must be a number", text, name));
      found->second = *number;
    } else {
      found->second = value;
    }
    std::erase(assumed, name);
  }
  return factors;
}

SceneLook look_at(scene::DrivePlan planned, protocol::Factors factors, scene::Planner& planner) {
  SceneLook look;
  look.scene = planned.scene.name;
  look.factors = std::move(factors);
  look.plan = std::move(planned);
  look.profile = planner.profile(look.plan, kProfilePoints);
  if (look.plan.tones.size() == 1)
    look.nearest_resonance_Hz = planner.nearest_resonance_Hz(look.plan, look.plan.tones[0].frequency_Hz);
  look.under = planner.under_finger(look.plan);
  if (look.plan.follow) {
    for (const auto events : {scene::Events::none, scene::Events::all})
      look.followed.push_back(scene::follow_curve(look.plan, kProfilePoints, events));
    if (look.followed[1].asked == look.followed[0].asked) look.followed.pop_back();
  }
  describe_plan(look);
  describe_cues(look);
  return look;
}

}  // namespace turnpoint::view

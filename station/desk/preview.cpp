#include "station/desk/preview.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "physics/edge.hpp"
#include "physics/surface.hpp"
#include "station/protocol/combinations.hpp"
#include "station/protocol/resolve.hpp"
#include "station/terms/usage_error.hpp"
#include "station/text/number.hpp"

namespace turnpoint::desk {

namespace {

using text::number;

protocol::FactorValue first_value(const protocol::Factor& factor) {
  if (!factor.levels.empty()) return factor.levels.front();
  if (factor.range) return 0.5 * (factor.range->first + factor.range->second);
  return 0.0;
}

std::string in_mm(const std::optional<double>& value_m, int digits = 5) {
  return value_m ? number(1e3 * *value_m, digits) + " mm" : "none";
}

std::string um(double value_m) { return number(1e6 * value_m, 3) + " \u00b5m"; }

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

/// Describes the scene in words.
void describe(SceneLook& look) {
  const auto& plan = look.plan;
  look.facts = {{"Boundary", in_mm(plan.boundary_m) + " (" + physics::format(plan.scene.edge) + ")"},
                {"Model", plan.reason.empty() ? std::string(physics::name(plan.model)) : plan.reason},
                {"Model error", "at most " + number(1e3 * plan.error_bound_m, 3) + " mm" +
                                    (plan.inside_tolerance ? "" : ", EXCEEDS the scene's tolerance")},
                {"Uncertain parameters", number(1e3 * plan.uncertainty_m, 3) + " mm (SD)"}};
  for (const auto& tone : plan.tones)
    look.facts.emplace_back("Tone", number(1e-3 * tone.frequency_Hz, 6) + " kHz, drive " +
                                        um(tone.amplitude_m) + " on " + tone.transducer + " (" +
                                        number(100 * tone.full_scale, 3) + " % of full scale)");
  if (plan.zone_friction)
    look.facts.emplace_back("Zone", "mean friction " + number(*plan.zone_friction, 3) + ", rms " +
                                        number(plan.residual.value_or(0), 2) + " about it");
  look.facts.emplace_back(
      "Surface", um(plan.peak_displacement_m) + " at most, crest factor " + number(plan.crest_factor, 3));
  look.facts.emplace_back("Lowest friction", number(plan.lowest_friction, 3) + " of the surface at rest");
  for (const auto& product : plan.audible_products)
    look.facts.emplace_back("Audible product",
                            number(product.frequency_Hz, 5) + " Hz, order " + std::to_string(product.order));
  for (const auto& warning : plan.warnings) look.facts.emplace_back("Warning", warning.text);
  const auto& cues = plan.cues;
  look.cues = {{"Pitch", cues.pitch_Hz > 0 ? number(cues.pitch_Hz, 5) + " Hz" : "inaudible"},
               {"Loudness", cues.pitch_Hz > 0 ? number(cues.loudness_dB, 3) + " dB re 1 \u00b5m" : "silent"},
               {"Amplitude at the wide end", um(cues.wide_end_amplitude_m)},
               {"Stripes at the wide end", in_mm(cues.stripe_pitch_m, 3) + " apart"},
               {"Width of the edge", in_mm(cues.edge_width_m, 3)},
               {"Strip width at the boundary", in_mm(cues.strip_width_m, 3)},
               {"Displacement at the last maximum", um(cues.displacement_m)}};
}

}  // namespace

Preview::Preview(protocol::Protocol protocol, rig::Rig rig)
    : protocol_(std::move(protocol)), rig_(std::move(rig)), planner_(rig_) {}

std::vector<std::string> Preview::scenes() const {
  std::vector<std::string> used, others;
  for (const auto& [name, scene] : protocol_.scenes) {
    bool shown = name == protocol_.task.standard || name == protocol_.task.target;
    for (const auto& interval : protocol_.task.intervals)
      shown = shown || std::find(interval.begin(), interval.end(), name) != interval.end();
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

Outline outline_of(const rig::Rig& rig) {
  const auto shape = scene::surface_of(rig);
  const double length_m = rig.surface.length_m;
  return {1e3 * length_m, 1e3 * physics::half_width_m(shape, 0), 1e3 * physics::half_width_m(shape, length_m),
          rig.surface.wide_end == rig::WideEnd::left};
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
      throw terms::UsageError(
          fmt::format("--set {}: write factor=value, with one of the factors {}", text, known));
    }
    const auto value = text.substr(equals + 1);
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    if (std::holds_alternative<double>(found->second)) {
      if (value.empty() || *end != '\0' || !std::isfinite(number))
        throw terms::UsageError(fmt::format("--set {}: the value of {} must be a number", text, name));
      found->second = number;
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
  look.under = planner.under_finger(look.plan);
  describe(look);
  return look;
}

}  // namespace turnpoint::desk

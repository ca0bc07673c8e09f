#include "station/protocol/resolve.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "physics/root.hpp"
#include "station/protocol/follow_target.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::protocol {

namespace {

physics::Edge edge_of(const Edge& edge) {
  if (edge.friction) return physics::Edge::friction(*edge.friction);
  return physics::parse_edge(edge.name.empty() ? "turning" : edge.name);
}

scene::ToneTarget tone_of(const SceneTone& tone, const Factors& factors) {
  scene::ToneTarget target;
  if (tone.boundary_mm) target.boundary_m = 1e-3 * evaluate(*tone.boundary_mm, factors);
  if (tone.frequency_Hz) target.frequency_Hz = evaluate(*tone.frequency_Hz, factors);
  target.edge = edge_of(tone.edge);
  target.displacement_m = 1e-6 * evaluate(tone.displacement_um, factors);
  target.phase_rad = tone.phase_deg * std::numbers::pi / 180;
  return target;
}

/// Everything about a scene that the expressions of a protocol can set; empty for what the scene does not
/// say.
std::vector<std::optional<double>> numbers_of(const scene::Scene& scene) {
  std::vector<std::optional<double>> numbers{scene.boundary_m, scene.displacement_m, scene.friction};
  if (scene.under_finger)
    numbers.insert(numbers.end(), {scene.under_finger->displacement_m, scene.under_finger->finger_m});
  if (scene.zone) numbers.insert(numbers.end(), {scene.zone->from_m, scene.zone->friction});
  for (const auto& tone : scene.tones)
    numbers.insert(numbers.end(), {tone.boundary_m, tone.frequency_Hz, tone.displacement_m, tone.phase_rad});
  if (scene.follow) {
    const auto followed = followed_numbers(*scene.follow);
    numbers.insert(numbers.end(), followed.begin(), followed.end());
  }
  return numbers;
}

}  // namespace

double friction_at_contrast(double reference, double contrast_dB) {
  return reference * (1 - std::pow(10.0, contrast_dB / 20));
}

scene::Scene resolve(const Protocol& protocol, const std::string& name, const Factors& factors,
                     double rove_dB) {
  const auto found = protocol.scenes.find(name);
  if (found == protocol.scenes.end()) throw std::out_of_range("no scene named \"" + name + "\"");
  const Scene& from = found->second;
  scene::Scene scene;
  scene.name = name;
  if (from.boundary_mm) scene.boundary_m = 1e-3 * evaluate(*from.boundary_mm, factors);
  scene.edge = edge_of(from.edge);
  if (from.displacement_um) scene.displacement_m = 1e-6 * evaluate(*from.displacement_um, factors);
  if (from.friction) scene.friction = evaluate(*from.friction, factors);
  if (from.displacement_under_finger_um && from.finger_mm)
    scene.under_finger = scene::FingerTarget{1e-6 * evaluate(*from.displacement_under_finger_um, factors),
                                             1e-3 * evaluate(*from.finger_mm, factors)};
  for (const auto& tone : from.tones) scene.tones.push_back(tone_of(tone, factors));
  if (from.zone) {
    scene::ZoneTarget zone;
    zone.from_m = 1e-3 * from.zone->from_mm.value_or(0);
    zone.friction = evaluate(*from.zone->friction, factors);
    zone.tones = from.zone->tones.value_or(1);
    zone.design_friction = evaluate(*from.zone->design_friction, factors);
    scene.zone = zone;
  }
  if (from.friction_contrast_dB) {
    const double contrast_dB = evaluate(*from.friction_contrast_dB, factors);
    if (scene.zone) scene.zone->friction = friction_at_contrast(*scene.zone->design_friction, contrast_dB);
    if (scene.friction) scene.friction = friction_at_contrast(*scene.friction, contrast_dB);
  }
  scene.rove_dB = rove_dB;
  scene.ramp_s = 1e-3 * from.ramp_ms;
  if (from.tolerance.boundary_mm) scene.tolerance.boundary_m = 1e-3 * *from.tolerance.boundary_mm;
  scene.tolerance.level_dB = from.tolerance.level_dB;
  scene.tolerance.friction = from.tolerance.friction;
  if (from.follow) try {
      const auto speed_mm_s = protocol.sensing ? protocol.sensing->speed_mm_s : std::nullopt;
      scene.follow =
          std::make_shared<const scene::FollowTarget>(follow_target(*from.follow, factors, speed_mm_s));
    } catch (const std::invalid_argument& error) {  // values that are not possible together
      throw scene::Unreachable(core::plain(error.what()));
    }
  return scene;
}

std::optional<double> where_equal(const Protocol& protocol, const std::string& one, const std::string& other,
                                  const std::string& factor, double low, double high, Factors factors) {
  const auto numbers_at = [&](const std::string& name, double value) {
    factors[factor] = value;
    return numbers_of(resolve(protocol, name, factors, 0));
  };
  std::optional<double> where;
  const auto size = numbers_at(one, low).size();
  if (numbers_at(other, low).size() != size) return std::nullopt;
  for (std::size_t i = 0; i < size; ++i) {
    const auto known = [&](double value) {
      return numbers_at(one, value)[i].has_value() && numbers_at(other, value)[i].has_value();
    };
    if (!known(low)) {
      if (numbers_at(one, low)[i].has_value() || numbers_at(other, low)[i].has_value()) return std::nullopt;
      continue;
    }
    const auto gap = [&](double value) { return *numbers_at(one, value)[i] - *numbers_at(other, value)[i]; };
    const double at_low = gap(low), at_high = gap(high);
    if (at_low == 0 && at_high == 0) continue;
    if (at_low * at_high > 0) return std::nullopt;
    const physics::Bracket ends =
        at_high > at_low ? physics::Bracket{high, low} : physics::Bracket{low, high};
    const double inside = physics::bisect(ends, [&](double value) { return gap(value) > 0; }).middle();
    const double mine = at_low == 0 ? low : at_high == 0 ? high : inside;
    if (where && std::fabs(*where - mine) > 1e-6 * (high - low)) return std::nullopt;
    if (!where) where = mine;
  }
  return where;
}

}  // namespace turnpoint::protocol

#include "station/scene/tone_designer.hpp"

#include <fmt/format.h>

#include "physics/centre_line.hpp"
#include "physics/field.hpp"
#include "station/core/limits.hpp"
#include "station/core/number.hpp"
#include "station/scene/measures.hpp"
#include "station/scene/transducer.hpp"

namespace turnpoint::scene {

using core::phrase, core::plain;

using core::number;

static_assert(core::kAudible_Hz == physics::audible_limit_Hz);

/// An edge defined by a percentage, a peak or a turning point does not depend on the displacement, so one map
/// for each edge definition is enough. The map covers the frequencies that this rig can play.
const physics::BoundaryMap& ToneDesigner::map_for(const physics::Edge& edge) {
  const auto key = physics::format(edge);
  auto found = maps_.find(key);
  if (found == maps_.end()) {
    physics::MapOptions options;
    options.edge = edge;
    options.band = {lowest_frequency(rig, 0),
                    highest_frequency(rig, core::kHighestShareOfRate * rig.output.rate_Hz)};
    found = maps_.emplace(key, std::make_shared<const physics::BoundaryMap>(surface, options)).first;
  }
  return *found->second;
}

physics::MapOptions ToneDesigner::edge_options(const physics::Edge& edge, double displacement_m) const {
  physics::MapOptions options;
  options.edge = edge;
  if (edge.kind == physics::Edge::Kind::friction)
    options.friction = physics::FrictionContext{friction, displacement_m, rig.friction.fingertip_m};
  return options;
}

double ToneDesigner::frequency_for(double boundary_m, const physics::Edge& edge, double displacement_m) {
  const auto options = edge_options(edge, displacement_m);
  if (edge.kind == physics::Edge::Kind::friction || surface.theory != physics::PlateTheory::kirchhoff) {
    // In two cases, making a map takes longer than solving for this one frequency. An edge defined by
    // friction depends on the displacement, which roving changes in every trial, so the map would be used
    // only once. For a thick plate, a map takes as long as twenty solutions.
    if (const auto frequency = physics::solve_frequency_Hz(surface, options, boundary_m)) return *frequency;
  } else if (const auto frequency = map_for(edge).frequency_Hz(boundary_m)) {
    return *frequency;
  }
  // No frequency that the rig can play puts the edge at `boundary_m`. Look at all frequencies, so that the
  // message can say whether any other does.
  const auto reach = physics::boundary_reach_m(surface, options);
  if (reach.contains(boundary_m))
    if (const auto frequency = physics::BoundaryMap(surface, options).frequency_Hz(boundary_m))
      return *frequency;
  throw Unreachable(phrase("problem.no_frequency",
                           {plain(physics::format(edge)), plain(number(1e3 * boundary_m)),
                            plain(number(1e3 * reach.first_m)), plain(number(1e3 * reach.last_m))}));
}

double ToneDesigner::target_displacement(const Scene& scene) const {
  if (scene.displacement_m) return *scene.displacement_m;
  if (scene.under_finger) return scene.under_finger->displacement_m;  // the planner computes the drive later
  const double wanted = scene.friction.value_or(1.0);
  if (const auto displacement = friction.displacement_m(wanted)) return *displacement;
  throw Unreachable(
      phrase("problem.friction_too_low", {plain(number(wanted)), plain(number(friction.lowest_friction()))}));
}

std::vector<ToneTarget> ToneDesigner::single(const Scene& scene) {
  const double displacement = target_displacement(scene) * std::pow(10.0, scene.rove_dB / 20);
  const double frequency = frequency_for(*scene.boundary_m, scene.edge, displacement);
  return {{scene.boundary_m, frequency, scene.edge, displacement, 0}};
}

std::vector<ToneTarget> ToneDesigner::explicit_tones(const Scene& scene) {
  auto tones = scene.tones;
  for (auto& tone : tones) {
    tone.displacement_m *= std::pow(10.0, scene.rove_dB / 20);
    if (!tone.frequency_Hz)
      tone.frequency_Hz = frequency_for(*tone.boundary_m, tone.edge, tone.displacement_m);
  }
  return tones;
}

/// Zones that differ in friction have tones of the same frequencies.
physics::SolvedLines ToneDesigner::lines_of(const std::vector<physics::Tone>& tones) {
  constexpr std::size_t most = 64;
  if (lines_.size() + tones.size() > most) lines_.clear();
  physics::SolvedLines lines;
  for (const auto& tone : tones) {
    auto& line = lines_[tone.frequency_Hz];
    if (!line) line = physics::make_centre_line(surface, tone.frequency_Hz, physics::Model::mode);
    lines.push_back(line);
  }
  return lines;
}

double ToneDesigner::unit_drive_m(const physics::Tone& tone) {
  const double frequency_Hz = on_grid(tone.frequency_Hz, kGridPerHz);
  auto found = unit_drive_m_.find(frequency_Hz);
  if (found == unit_drive_m_.end())
    found = unit_drive_m_.emplace(frequency_Hz, physics::drive_amplitude_m(surface, frequency_Hz, 1)).first;
  return found->second;
}

std::vector<ToneTarget> ToneDesigner::zone(const Scene& scene, DrivePlan& plan) {
  const auto& wanted = *scene.zone;
  const double designed_for = wanted.design_friction.value_or(wanted.friction);
  const auto key = fmt::format("{} {} {} {} {}", *scene.boundary_m, physics::format(scene.edge),
                               wanted.from_m, designed_for, wanted.tones);
  auto found = designs_.find(key);
  if (found == designs_.end()) {
    physics::ZoneRequest request;
    request.from_m = wanted.from_m;
    request.boundary_m = *scene.boundary_m;
    request.edge = scene.edge;
    request.friction = designed_for;
    request.tones = wanted.tones;
    request.fingertip_m = rig.friction.fingertip_m;
    request.band.low_Hz = lowest_frequency(rig, core::kAudible_Hz);
    request.band.high_Hz = highest_frequency(rig, core::kHighestShareOfRate * rig.output.rate_Hz);
    if (const auto refused = refused_.find(key); refused != refused_.end()) throw refused->second;
    const auto design = [&] {
      try {
        return zones_.design(request);
      } catch (const physics::Refused& refused) {
        refused_.emplace(key, refused);
        throw;
      }
    };
    DesignedZone designed{design(), {}, {}};
    for (const auto& tone : designed.design.tones) designed.unit_drive_m.push_back(unit_drive_m(tone));
    found = designs_.emplace(key, std::move(designed)).first;
  }
  auto& [design, unit_drive_m, amplitude_m] = found->second;
  const auto& tones = design.tones;
  plan.boundary_m = design.boundary_m;
  double scale = 1;
  if (wanted.friction != designed_for) {
    const auto x_m = physics::linspace_points(surface, profile_points);
    if (amplitude_m.empty())
      amplitude_m = physics::amplitude_profile(surface, tones, x_m, physics::Model::mode, lines_of(tones));
    scale = scale_to_friction(x_m, amplitude_m, friction, rig, scene);
  }
  scale *= std::pow(10.0, scene.rove_dB / 20);
  std::vector<ToneTarget> list;
  for (std::size_t i = 0; i < tones.size(); ++i)
    list.push_back({{},
                    on_grid(tones[i].frequency_Hz, kGridPerHz),
                    scene.edge,
                    scale * tones[i].amplitude_m / unit_drive_m[i],
                    tones[i].phase_rad});
  return list;
}

std::vector<ToneTarget> ToneDesigner::tones_for(const Scene& scene, DrivePlan& plan) {
  if (scene.zone) return zone(scene, plan);
  if (!scene.tones.empty()) return explicit_tones(scene);
  return single(scene);
}

}  // namespace turnpoint::scene

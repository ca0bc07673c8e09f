#include "station/rig/physical.hpp"

#include <stdexcept>

#include "physics/boundary_budget.hpp"
#include "physics/boundary_fit.hpp"

namespace turnpoint::rig {

namespace {

physics::TaperForm taper_of(const Taper& taper) {
  if (taper.slope) return physics::LinearTaper{taper.half_width_m, *taper.slope};
  if (taper.decay_length_m) return physics::ExponentialTaper{taper.half_width_m, *taper.decay_length_m};
  physics::TabulatedTaper table;
  for (const auto& [x, w] : taper.profile_m) table.points.push_back({x, w});
  return table;
}

physics::Bending bending_of(Bending bending) {
  switch (bending) {
    case Bending::on:
      return physics::Bending::on;
    case Bending::off:
      return physics::Bending::off;
    case Bending::automatic:
      break;
  }
  return physics::Bending::automatic;
}

/// Returns the plate theory for this surface. If the rig file leaves the choice open, this is the most exact
/// theory in which every model can be computed for the surface.
physics::PlateTheory theory_of(PlateTheory theory, const Surface& surface) {
  switch (theory) {
    case PlateTheory::kirchhoff:
      return physics::PlateTheory::kirchhoff;
    case PlateTheory::mindlin:
      return physics::PlateTheory::mindlin;
    case PlateTheory::elastic:
      return physics::PlateTheory::elastic;
    case PlateTheory::automatic:
      break;
  }
  const bool clamped_plate = surface.tension_Pa == 0 && surface.edges == Edges::clamped;
  const double poisson = surface.poisson.value_or(-1);
  return clamped_plate && poisson >= 0 && poisson <= 0.49 ? physics::PlateTheory::mindlin
                                                          : physics::PlateTheory::kirchhoff;
}

physics::Surface fitted(physics::Surface surface, const SurfaceFit& fit) {
  std::vector<physics::FittedParameter> parameters;
  std::vector<physics::Correlation> correlations;
  for (const auto& p : fit.parameters) {
    const auto parameter = physics::find_parameter(p.name);
    if (!parameter)
      throw std::invalid_argument("the calibration fits an unknown parameter, \"" + p.name + "\"");
    for (std::size_t k = 0; k < p.correlations.size() && k < parameters.size(); ++k)
      correlations.push_back({parameters[k].parameter, *parameter, p.correlations[k]});
    parameters.push_back({*parameter, p.change, p.sd, p.stated_sd});
  }
  return physics::with_fit(std::move(surface), parameters, correlations);
}

core::Phrase said(const physics::Statement& statement, const std::string& table) {
  std::vector<core::Phrase> values;
  for (const auto& value : statement.values) values.push_back(core::plain(value));
  return core::phrase(table + "." + statement.code, std::move(values));
}

}  // namespace

physics::Surface surface_of(const Rig& rig) {
  const auto& s = rig.surface;
  physics::Surface surface;
  surface.density_kg_m3 = s.density_kg_m3;
  surface.tension_Pa = s.tension_Pa;
  surface.thickness_m = s.thickness_m;
  surface.length_m = s.length_m;
  surface.quality_factor = s.quality_factor;
  surface.taper = taper_of(s.taper);
  surface.edges = s.edges == Edges::clamped ? physics::Edges::clamped : physics::Edges::supported;
  surface.bending = bending_of(s.bending);
  surface.modulus_Pa = s.modulus_Pa;
  if (s.poisson) surface.poisson = *s.poisson;
  surface.theory = theory_of(s.plate_theory, s);
  surface.yield_strength_Pa = s.yield_Pa;
  surface.sd.density_kg_m3 = s.density_sd_kg_m3;
  surface.sd.tension_Pa = s.tension_sd_Pa;
  surface.sd.thickness_m = s.thickness_sd_m;
  surface.sd.modulus_Pa = s.modulus_sd_Pa;
  surface.sd.half_width_m = s.half_width_sd_m;
  surface.sd.slope = s.slope_sd;
  surface.sd.decay_length_m = s.decay_length_sd_m;
  surface.sd.clamp_line_m = s.clamp_line_sd_m;
  surface.sd.temperature_K = s.temperature_sd_K;
  surface.sd.quality_factor = s.quality_factor_sd;
  surface.expansion_per_K = s.expansion_per_K;
  surface.modulus_per_K = s.modulus_per_K;
  if (!s.fit.parameters.empty()) surface = fitted(std::move(surface), s.fit);
  physics::validate(surface);
  return surface;
}

Outline outline_of(const Rig& rig) {
  const auto shape = surface_of(rig);
  const double length_m = rig.surface.length_m;
  return {1e3 * length_m, 1e3 * physics::half_width_m(shape, 0), 1e3 * physics::half_width_m(shape, length_m),
          rig.surface.wide_end == WideEnd::left};
}

physics::FrictionMap friction_of(const Rig& rig) {
  if (!rig.friction.measured) {
    physics::LoadSharing model;
    model.pressure_Pa = rig.friction.pressure_Pa;
    model.floor = rig.friction.floor;
    return physics::FrictionMap(model);
  }
  std::vector<physics::FrictionPoint> points;
  for (const auto& [displacement_m, relative] : falling(rig.friction.table))
    points.push_back({displacement_m, relative, 0});
  return physics::FrictionMap(points);
}

core::Phrase phrase_of(const physics::Warning& warning) { return said(warning, "physics_warning"); }
core::Phrase phrase_of(const physics::Refused& refused) { return said(refused.why(), "physics_refusal"); }

}  // namespace turnpoint::rig

#pragma once
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "physics/boundary_map.hpp"
#include "physics/friction.hpp"
#include "physics/zone.hpp"
#include "station/rig/rig.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

/// Planned tones are rounded to a grid, because processors and C libraries differ in the last bits of sines
/// and logarithms, and the same session must give the same samples everywhere. The grid is far finer than
/// what matters: 1 uHz, 1 fm (-180 dB re 1 um), 1 nrad.
inline constexpr double kGridPerHz = 1e6, kGridPerMetre = 1e15, kGridPerRadian = 1e9;
inline double on_grid(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

/// A tone that a scene asks for, before a model is chosen. The frequency is the first mode's.
struct WantedTone {
  double frequency_Hz = 0;
  double displacement_m = 0;  ///< at its last maximum
  double phase_rad = 0;
  physics::Edge edge;
  std::optional<double> boundary_m;  ///< where the tone's own edge shall lie; empty for tones of a zone
};

/// Finds the tones that a scene asks for, by the first mode on this rig's surface. Keeps boundary maps and
/// zone designs.
class ToneDesigner {
 public:
  explicit ToneDesigner(const rig::Rig& r) : rig(r), surface(surface_of(r)), friction(friction_of(r)) {}

  /// Sets the boundary of `plan` for a zone. Throws Unreachable.
  std::vector<WantedTone> tones_for(const Scene& scene, DrivePlan& plan);
  /// Percent, peak and turning edges only: the map covers the tones that this rig can play.
  const physics::BoundaryMap& map_for(const physics::Edge& edge);
  /// How an edge is found where the surface moves this much.
  physics::MapOptions edge_options(const physics::Edge& edge, double displacement_m) const;

  rig::Rig rig;
  physics::Surface surface;
  physics::FrictionMap friction;

 private:
  double frequency_for(double boundary_m, const physics::Edge& edge, double displacement_m);
  double target_displacement(const Scene& scene) const;
  std::vector<WantedTone> single(const Scene& scene);
  std::vector<WantedTone> explicit_tones(const Scene& scene);
  std::vector<WantedTone> zone(const Scene& scene, DrivePlan& plan);

  std::map<std::string, std::shared_ptr<const physics::BoundaryMap>> maps_;
  std::map<std::string, physics::ZoneDesign> designs_;
};

}  // namespace turnpoint::scene

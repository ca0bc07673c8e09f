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

/// Frequencies, amplitudes and phases of planned tones are rounded to multiples of 1 uHz, 1 fm (-180 dB re 1
/// um) and 1 nrad. The reason: the last bits of sines and logarithms differ between processors and C
/// libraries, but the same session must give the same samples everywhere. The steps are far too small to
/// matter.
inline constexpr double kGridPerHz = 1e6, kGridPerMetre = 1e15, kGridPerRadian = 1e9;
inline double on_grid(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

/// Finds the tones that a scene needs, by computing with the first mode of this rig's surface. Caches
/// boundary maps and zone designs.
class ToneDesigner {
 public:
  explicit ToneDesigner(const rig::Rig& r) : rig(r), surface(surface_of(r)), friction(friction_of(r)) {}
  /// A copy has the maps and zones that were found, and solves further zones by itself.
  ToneDesigner(const ToneDesigner& other)
      : rig(other.rig),
        surface(other.surface),
        friction(other.friction),
        maps_(other.maps_),
        designs_(other.designs_),
        refused_(other.refused_),
        unit_drive_m_(other.unit_drive_m_),
        lines_(other.lines_) {}

  /// Returns the tones of a scene, all with a frequency; those that must place an edge have a boundary, too.
  /// The vibration model for the final plan is chosen later. If the scene is a zone of uniform friction, also
  /// sets `plan.boundary_m`. Throws Unreachable if no frequency of this rig can produce the scene.
  std::vector<ToneTarget> tones_for(const Scene& scene, DrivePlan& plan);
  /// Returns the map of boundaries for an edge defined by a percentage, a peak or a turning point. The map
  /// covers the tones that this rig can play.
  const physics::BoundaryMap& map_for(const physics::Edge& edge);
  /// Returns the options for finding this edge on a surface that moves by `displacement_m`.
  physics::MapOptions edge_options(const physics::Edge& edge, double displacement_m) const;

  rig::Rig rig;
  physics::Surface surface;
  physics::FrictionMap friction;

 private:
  double frequency_for(double boundary_m, const physics::Edge& edge, double displacement_m);
  double target_displacement(const Scene& scene) const;
  std::vector<ToneTarget> single(const Scene& scene);
  std::vector<ToneTarget> explicit_tones(const Scene& scene);
  std::vector<ToneTarget> zone(const Scene& scene, DrivePlan& plan);
  physics::SolvedLines lines_of(const std::vector<physics::Tone>& tones);
  double unit_drive_m(const physics::Tone& tone);

  std::map<std::string, std::shared_ptr<const physics::BoundaryMap>> maps_;
  physics::ZoneDesigner zones_{surface, friction};
  /// A zone, the drive amplitude of each tone (frequency on the grid) for 1 m at its last maximum, and the
  /// amplitude of the zone at `profile_points` points; empty until it is needed.
  struct DesignedZone {
    physics::ZoneDesign design;
    std::vector<double> unit_drive_m, amplitude_m;
  };
  std::map<std::string, DesignedZone> designs_;
  std::map<std::string, physics::Refused> refused_;  ///< why the other zones cannot be designed
  std::map<double, double> unit_drive_m_;            ///< by frequency
  /// the solutions of the first mode for the tones of the last zones, by frequency
  std::map<double, std::shared_ptr<const physics::CentreLine>> lines_;
};

}  // namespace turnpoint::scene

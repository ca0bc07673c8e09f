#pragma once
#include <optional>
#include <string>
#include <vector>

#include "physics/edge.hpp"

namespace turnpoint::scene {

/// One explicit tone, placed by its boundary or by its frequency (exactly one is set).
struct ToneTarget {
  std::optional<double> boundary_m, frequency_Hz;
  physics::Edge edge;
  double displacement_m = 0;  ///< peak, at the tone's last maximum
  double phase_rad = 0;
};

/// A zone of even friction from `from_m` to the scene's boundary.
struct ZoneTarget {
  double from_m = 0;
  double friction = 1;  ///< wanted mean over the zone, relative to the surface at rest
  int tones = 1;        ///< at most so many
  std::optional<double>
      design_friction;  ///< tones are chosen for this one and then only scaled to `friction`
};

/// What a scene must be right to; what is absent is not asked for.
struct Tolerance {
  std::optional<double> boundary_m, level_dB, friction;
};

/// What one interval presents on the surface, in numbers: exactly one of boundary alone, explicit tones, or a
/// zone (which has a boundary too). SI units.
struct Scene {
  std::string name;
  std::optional<double> boundary_m;
  physics::Edge edge;
  std::optional<double> displacement_m, friction;  ///< at the last maximum; for a boundary alone, one is set
  std::vector<ToneTarget> tones;
  std::optional<ZoneTarget> zone;
  double rove_dB = 0;  ///< drawn for this trial, added to every displacement
  double ramp_s = 0.050;
  Tolerance tolerance;
};

}  // namespace turnpoint::scene

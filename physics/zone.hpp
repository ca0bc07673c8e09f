#pragma once
// Inverse design: finds the tones that produce a desired zone of friction, or a desired profile of amplitude.
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "physics/edge.hpp"
#include "physics/friction.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"
#include "physics/warning.hpp"

namespace turnpoint::physics {

// The frequencies that may be used, and the smallest difference between two of them. Below `spacing_Hz`, the
// beats between two tones could be felt.
struct ToneBand {
  double low_Hz = audible_limit_Hz;
  double high_Hz = 45000;
  double spacing_Hz = 1000;
  bool operator==(const ToneBand&) const = default;
};

// Describes a zone from from_m to boundary_m with the mean relative friction `friction`. boundary_m is the
// required position of `edge`. The edge belongs to the amplitude profile of the whole zone: the root of
// summed squares over its tones. If the edge is `turning`, it is that of the highest tone.
struct ZoneRequest {
  double from_m = 0;
  double boundary_m = 0;
  Edge edge = Edge::turning();
  double friction = 0.6;  // wanted relative friction: mean over the fingertip and over [from_m, boundary_m]
  int tones = 3;          // largest number of tones
  ToneBand band;
  double fingertip_m = 10e-3;
  bool operator==(const ZoneRequest&) const = default;
};

struct ZoneDesign {
  // highest frequency first; amplitudes are at the drive edge, and phases give a low crest factor
  std::vector<Tone> tones;
  double boundary_m = 0;  // where the edge of the designed zone lies
  double friction = 0;    // mean friction of the designed zone
  double residual = 0;    // rms deviation of the fingertip-averaged friction from its mean in the zone
  // smallest squared amplitude in the zone (summed over tones), divided by the mean squared amplitude
  double node_fill = 0;
  double peak_displacement_m = 0;  // largest amplitude on the surface with all tones in phase
  double crest_factor = 0;         // crest factor of the drive waveform
  std::string reason;              // how the tones were placed, and what limits them
  std::vector<Warning> warnings;
};

// Designs a zone. Throws Refused if no tones can produce it: a zone beyond the surface, friction below the
// lowest of the map, a boundary whose tone lies outside the band, or a friction edge whose level is outside
// (friction, 1).
ZoneDesign design_zone(const Surface& surface, const FrictionMap& friction, const ZoneRequest& request);

class ZoneProfile;

// Designs many zones on one surface: the designs are those of design_zone(). Friction changes only the level
// of the tones if the place of the edge does not depend on it, so of such zones with the same other values,
// only the first is solved. Keeps references to its surface and its friction.
class ZoneDesigner {
 public:
  ZoneDesigner(const Surface& surface, const FrictionMap& friction);
  ~ZoneDesigner();
  // Throws as design_zone().
  ZoneDesign design(const ZoneRequest& request);

 private:
  struct Solved;
  const Solved& solve(const ZoneRequest& request);

  const Surface& surface_;
  const FrictionMap& friction_;
  std::vector<std::unique_ptr<Solved>> solved_;  // the last ones, the newest at the end
};

struct ProfilePoint {
  double x_m = 0;
  double amplitude_m = 0;  // desired amplitude, as the root of summed squares over tones
};

struct ProfileDesign {
  std::vector<Tone> tones;
  // rms of (actual - desired) squared amplitude, divided by the rms of the desired one
  double residual = 0;
  bool reachable = false;  // true if `residual` is at most 0.25
  std::string verdict;
};

// Designs a profile. The squared amplitudes sum a_i^2 |v_i|^2 are fitted to the target by non-negative least
// squares; candidate frequencies are band.spacing_Hz apart. In general, only profiles that fall with x can be
// produced. `residual` and `reachable` say how close the design comes to the target.
ProfileDesign design_profile(const Surface& surface, std::span<const ProfilePoint> target,
                             const ToneBand& band);

}  // namespace turnpoint::physics

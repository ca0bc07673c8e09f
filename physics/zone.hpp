#pragma once
// Inverse design: tones that give a desired zone of friction, or a desired profile of amplitude.
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

// Frequencies that may be used, and how far apart tones must be so that their beats are not felt.
struct ToneBand {
  double low_Hz = audible_limit_Hz;
  double high_Hz = 45000;
  double spacing_Hz = 1000;
};

// A zone of mean relative friction `friction` from from_m to boundary_m, its end being `edge` of the zone's
// own profile: with several tones amplitude is the root of summed squares, and turning means the highest
// tone's.
struct ZoneRequest {
  double from_m = 0;
  double boundary_m = 0;
  Edge edge = Edge::turning();
  double friction = 0.6;  // mean over [from_m, boundary_m] of friction averaged over the fingertip
  int tones = 3;          // largest number of tones
  ToneBand band;
  double fingertip_m = 10e-3;
};

struct ZoneDesign {
  std::vector<Tone> tones;  // amplitudes at the drive edge, phases for a low crest factor; highest first
  double boundary_m = 0;    // actual boundary, by the requested edge
  double friction = 0;      // reached mean
  double residual = 0;      // rms of (friction - mean) over the zone, fingertip averaged
  double node_fill = 0;     // minimum over mean of the summed squared amplitude in the zone
  double peak_displacement_m = 0;  // largest amplitude on the surface, tones summed in phase
  double crest_factor = 0;         // of the drive waveform
  std::string reason;              // how the tones were placed, and what limits them
  std::vector<Warning> warnings;
};

// Designs a zone; throws std::domain_error saying what cannot be reached (friction below the map's lowest, a
// boundary whose tone lies outside the band, a friction edge outside (friction, 1)).
ZoneDesign design_zone(const Surface& surface, const FrictionMap& friction, const ZoneRequest& request);

struct ProfilePoint {
  double x_m = 0;
  double amplitude_m = 0;  // desired root of summed squares
};

struct ProfileDesign {
  std::vector<Tone> tones;
  double residual = 0;     // rms of (actual - desired) squared amplitude over rms of the desired one
  bool reachable = false;  // residual at most 0.25
  std::string verdict;
};

// Non-negative least squares on sum a_i^2 |v_i|^2 over candidate frequencies spaced by band.spacing_Hz.
// Essentially only profiles that fall with x can be reached; the verdict says how well this one is.
ProfileDesign design_profile(const Surface& surface, std::span<const ProfilePoint> target,
                             const ToneBand& band);

}  // namespace turnpoint::physics

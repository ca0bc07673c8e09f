#pragma once
// Warnings that a plan, a map or a field should show, each only once.
#include <span>
#include <string>
#include <vector>

#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

// A stable code for programs ("yield", "bending-off", "audible", "resonance-gain",
// "outside-surface", "no-smooth-zone", "narrow-strip", "thick-plate", "ill-conditioned", "beat") and a
// sentence for people.
struct Warning {
  std::string code;
  std::string text;
};

// Warns of a tension above the material's yield strength, and of bending that matters but is off.
std::vector<Warning> surface_warnings(const Surface& surface);

// A tone below this frequency may be audible: the lower edge of the third-octave band centred on 25 kHz.
inline constexpr double audible_limit_Hz = 22400;

// Warnings about single tones: below 22.4 kHz, turning point outside the surface, strip narrower than a
// fingertip (14 mm) at the turning point, last-lobe gain above 10, plate theory
// kirchhoff where shear moves the boundary by more than 1 mm. Codes are not repeated per tone.
std::vector<Warning> tone_warnings(const Surface& surface, std::span<const Tone> tones);

}  // namespace turnpoint::physics

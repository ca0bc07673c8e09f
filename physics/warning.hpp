#pragma once
// Warnings to show with a plan, a map or a field, each only once.
#include <span>
#include <string>
#include <vector>

#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

// A warning: a stable code for programs ("yield", "bending-off", "audible", "resonance-gain",
// "outside-surface", "no-smooth-zone", "narrow-strip", "thick-plate", "ill-conditioned", "beat") and a
// sentence for people.
struct Warning {
  std::string code;
  std::string text;
};

// Warns if the tension is above the material's yield strength, or if bending is switched off although it
// matters.
std::vector<Warning> surface_warnings(const Surface& surface);

// A tone below this frequency may be audible: the lower edge of the third-octave band centred on 25 kHz.
inline constexpr double audible_limit_Hz = 22400;

// Warns about single tones: below 22.4 kHz, turning point outside the surface, strip narrower than a
// fingertip (14 mm) at the turning point, gain at the last maximum above 10, plate theory kirchhoff where
// shear moves the boundary by more than 1 mm. Each code appears once, not once per tone.
std::vector<Warning> tone_warnings(const Surface& surface, std::span<const Tone> tones);

}  // namespace turnpoint::physics

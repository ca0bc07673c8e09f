#pragma once
// Warnings to show with a plan, a map or a field. Each kind is shown only once.
#include <array>
#include <span>
#include <vector>

#include "physics/statement.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

// The codes of all warnings, for programs.
inline constexpr std::array warning_codes{
    "yield",        "audible",        "bending-off",     "thick-plate", "no-smooth-zone", "outside-surface",
    "narrow-strip", "resonance-gain", "ill-conditioned", "air-loss",    "air-mass"};

// A warning: one of these codes, and a sentence for people.
using Warning = Statement;

// Warns if the tension is above the material's yield strength, or if bending is switched off although it
// matters.
std::vector<Warning> surface_warnings(const Surface& surface);

// A tone below this frequency may be audible: the lower edge of the third-octave band centred on 25 kHz.
inline constexpr double audible_limit_Hz = 22400;

// Warns if a tone is below 22.4 kHz, if its turning point is outside the surface, if the strip is narrower
// than a fingertip (14 mm) there, if the air alone damps it more than the stated quality factor says or adds
// a tenth to its mass, if the gain at the last maximum is above 10, or if plate theory kirchhoff is used
// although shear moves the boundary by more than 1 mm. Each code appears once, not once per tone.
// `solved` may contain the solutions of the model `mode` for these tones; they are then not solved again.
std::vector<Warning> tone_warnings(const Surface& surface, std::span<const Tone> tones,
                                   const SolvedLines& solved = {});

}  // namespace turnpoint::physics

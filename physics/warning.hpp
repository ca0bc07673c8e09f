#pragma once
// Warnings to show with a plan, a map or a field. Each kind is shown only once.
#include <array>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

// The codes of all warnings, for programs.
inline constexpr std::array warning_codes{"yield",        "audible",        "bending-off",
                                          "thick-plate",  "no-smooth-zone", "outside-surface",
                                          "narrow-strip", "resonance-gain", "ill-conditioned"};

// A warning: one of these codes, and a sentence for people.
struct Warning {
  std::string code;
  std::string text;
  std::vector<std::string>
      values;  // the numbers of the sentence, for a program that says it in another language
};

// Makes a warning with this sentence, in which %1, %2 and so on stand for the values. `digits` is the number
// of significant digits of each value.
Warning make_warning(std::string code, const std::string& sentence, std::initializer_list<double> values,
                     int digits = 6);

// Warns if the tension is above the material's yield strength, or if bending is switched off although it
// matters.
std::vector<Warning> surface_warnings(const Surface& surface);

// A tone below this frequency may be audible: the lower edge of the third-octave band centred on 25 kHz.
inline constexpr double audible_limit_Hz = 22400;

// Warns if a tone is below 22.4 kHz, if its turning point is outside the surface, if the strip is narrower
// than a fingertip (14 mm) there, if the gain at the last maximum is above 10, or if plate theory kirchhoff
// is used although shear moves the boundary by more than 1 mm. Each code appears once, not once per tone.
std::vector<Warning> tone_warnings(const Surface& surface, std::span<const Tone> tones);

}  // namespace turnpoint::physics

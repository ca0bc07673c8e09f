#include "physics/warning.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "physics/airborne.hpp"
#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/gate.hpp"
#include "physics/plate_theory.hpp"
#include "physics/statement.hpp"

namespace turnpoint::physics {
namespace {

constexpr double finger_width_m = 14e-3;
constexpr double high_gain = 10;
constexpr double noticeable_shift_m = 1e-3;
constexpr double noticeable_air = 0.1;

// Adds the warning, unless the list has one with the same code.
void add(std::vector<Warning>& list, Warning&& warning) {
  for (const Warning& one : list) {
    if (one.code == warning.code) return;
  }
  list.push_back(std::move(warning));
}

}  // namespace

std::vector<Warning> surface_warnings(const Surface& s) {
  std::vector<Warning> list;
  if (s.yield_strength_Pa && s.tension_Pa > *s.yield_strength_Pa)
    add(list, make_statement("yield", "tension %1 MPa exceeds the material's yield strength, %2 MPa",
                             {s.tension_Pa / 1e6, *s.yield_strength_Pa / 1e6}));
  return list;
}

std::vector<Warning> tone_warnings(const Surface& s, std::span<const Tone> tones, const SolvedLines& solved) {
  if (!solved.empty() && solved.size() != tones.size())
    throw std::invalid_argument("warnings need as many solutions as tones, or none");
  std::vector<Warning> list;
  const auto warn = [&list](const char* code, const char* sentence,
                            std::initializer_list<StatementValue> values) {
    add(list, make_statement(code, sentence, values));
  };
  for (std::size_t i = 0; i < tones.size(); ++i) {
    const Tone& tone = tones[i];
    const double f = tone.frequency_Hz, kHz = f / 1e3;
    validate(s, f);
    if (f < audible_limit_Hz)
      warn("audible",
           "%1 kHz: below 22.4 kHz, so it may be audible, and the stricter limit of airborne sound applies",
           {kHz});
    const auto stiffness = bending_stiffness_N_m(s);
    if (stiffness && !bending_modelled(s)) {
      const double k = wavenumber_per_m(s, f);
      const double ratio = *stiffness * k * k / line_tension_N_per_m(s);
      if (ratio > 0.01)
        warn("bending-off", "%1 kHz: bending adds %2 % to the restoring force, but is not modelled",
             {kHz, 100 * ratio});
    }
    const double shift = s.theory == PlateTheory::kirchhoff ? shear_shift_m(s, f).value_or(0) : 0;
    if (std::abs(shift) > noticeable_shift_m)
      warn("thick-plate",
           "%1 kHz: the plate is thick: shear, which plate theory kirchhoff leaves out, would move the "
           "boundary "
           "by %2 mm",
           {{kHz, 3}, {shift * 1e3, 3}});
    if (f <= cut_off_frequency_Hz(s, half_width_m(s, 0))) {
      warn("no-smooth-zone", "%1 kHz: no smooth zone, below the drive edge's cut-off", {kHz});
    } else if (!turning_point_m(s, f)) {
      warn("outside-surface", "%1 kHz: turning point beyond the surface", {kHz});
    } else if (2 * cut_off_half_width_m(s, f) < finger_width_m) {
      warn("narrow-strip",
           "%1 kHz: the strip is %2 mm wide at the turning point, narrower than a finger (14 mm)",
           {kHz, 2e3 * cut_off_half_width_m(s, f)});
    }
    const AirLoad air = air_load(s, f);
    if (std::isfinite(s.quality_factor) && air.quality_factor && *air.quality_factor < s.quality_factor)
      warn("air-loss",
           "%1 kHz: sound that the surface radiates limits its quality factor to %2, below the stated %3",
           {{kHz, 3}, {*air.quality_factor, 3}, {s.quality_factor, 3}});
    if (air.mass_share > noticeable_air)
      warn("air-mass",
           "%1 kHz: the air that moves with the surface adds %2 % to its mass, which the model leaves out",
           {{kHz, 3}, {100 * air.mass_share, 3}});
    const bool linear = std::holds_alternative<LinearTaper>(s.taper);
    const auto line = linear && !solved.empty()
                          ? solved[i]
                          : make_centre_line(linear ? s : moving_part(s, f), f, Model::mode);
    const auto peak = line->last_peak_m();
    if (!peak) continue;
    const double ln_gain = line->value(*peak).ln_magnitude() - line->value(0).ln_magnitude();
    if (ln_gain > std::log(high_gain))
      warn("resonance-gain", "%1 kHz: resonance gain above 10 (%2)",
           {kHz, std::exp(std::min(ln_gain, 700.0))});
  }
  return list;
}

}  // namespace turnpoint::physics

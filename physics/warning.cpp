#include "physics/warning.hpp"

#include <cmath>
#include <sstream>

#include "physics/centre_line.hpp"
#include "physics/dispersion.hpp"
#include "physics/field.hpp"
#include "physics/plate_theory.hpp"

namespace turnpoint::physics {
namespace {

constexpr double finger_width_m = 14e-3;
constexpr double high_gain = 10;
constexpr double noticeable_shift_m = 1e-3;

void add(std::vector<Warning>& list, const char* code, const std::ostringstream& text) {
  for (const Warning& one : list) {
    if (one.code == code) return;
  }
  list.push_back({code, text.str()});
}

}  // namespace

std::vector<Warning> surface_warnings(const Surface& s) {
  std::vector<Warning> list;
  if (s.yield_strength_Pa && s.tension_Pa > *s.yield_strength_Pa) {
    std::ostringstream text;
    text << "tension " << s.tension_Pa / 1e6 << " MPa exceeds the material's yield strength, "
         << *s.yield_strength_Pa / 1e6 << " MPa";
    add(list, "yield", text);
  }
  return list;
}

std::vector<Warning> tone_warnings(const Surface& s, std::span<const Tone> tones) {
  std::vector<Warning> list;
  for (const Tone& tone : tones) {
    const double f = tone.frequency_Hz;
    std::ostringstream text;
    text << f / 1e3 << " kHz";
    if (f < audible_limit_Hz) {
      text << ": below 22.4 kHz, so it may be audible, and the stricter limit of airborne sound applies";
      add(list, "audible", text);
      text.str("");
      text << f / 1e3 << " kHz";
    }
    const auto stiffness = bending_stiffness_N_m(s);
    if (stiffness && !bending_modelled(s)) {
      const double k = wavenumber_per_m(s, f);
      const double ratio = *stiffness * k * k / line_tension_N_per_m(s);
      if (ratio > 0.01) {
        std::ostringstream bend;
        bend << f / 1e3 << " kHz: bending adds " << 100 * ratio
             << " % to the restoring force, but is not modelled";
        add(list, "bending-off", bend);
      }
    }
    const double shift = s.theory == PlateTheory::kirchhoff ? shear_shift_m(s, f).value_or(0) : 0;
    if (std::abs(shift) > noticeable_shift_m) {
      std::ostringstream thick;
      thick.precision(3);
      thick << f / 1e3
            << " kHz: the plate is thick: shear, which plate theory kirchhoff leaves out, would move "
            << "the boundary by " << shift * 1e3 << " mm";
      add(list, "thick-plate", thick);
    }
    if (f <= cut_off_frequency_Hz(s, half_width_m(s, 0))) {
      text << ": no smooth zone, below the drive edge's cut-off";
      add(list, "no-smooth-zone", text);
    } else if (!turning_point_m(s, f)) {
      text << ": turning point beyond the surface";
      add(list, "outside-surface", text);
    } else if (2 * cut_off_half_width_m(s, f) < finger_width_m) {
      text << ": the strip is " << 2e3 * cut_off_half_width_m(s, f)
           << " mm wide at the turning point, narrower than a finger (14 mm)";
      add(list, "narrow-strip", text);
    }
    const bool linear = std::holds_alternative<LinearTaper>(s.taper);
    const auto line = make_centre_line(linear ? s : moving_part(s, f), f, Model::mode);
    const auto peak = line->last_peak_m();
    if (!peak) continue;
    const double ln_gain = line->value(*peak).ln_magnitude() - line->value(0).ln_magnitude();
    if (ln_gain > std::log(high_gain)) {
      std::ostringstream gain;
      gain << f / 1e3 << " kHz: resonance gain above 10 (" << std::exp(std::min(ln_gain, 700.0)) << ")";
      add(list, "resonance-gain", gain);
    }
  }
  return list;
}

}  // namespace turnpoint::physics

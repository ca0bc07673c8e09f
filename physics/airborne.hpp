#pragma once
// Sound in air above a vibrating surface, by Rayleigh's integral (Strutt 1878, Theory of Sound, section 278;
// Pierce, Acoustics, section 5-2) over the planned field. The clamp frame is treated as an infinite rigid
// baffle and air as lossless; both make the computed sound louder than the real one.
#include <complex>
#include <span>
#include <vector>

#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

struct Air {
  double density_kg_m3 = 1.204;  // dry air at 20 degrees C and 101.325 kPa
  double speed_m_s = 343.2;
};

// A place, measured from the centre of the drive edge: x along the strip, y across, z above the surface.
struct Place {
  double x_m = 0, y_m = 0, z_m = 0;
};

// A part of the surface that moves up and down as a whole; it must be small compared with the wavelength in
// air.
struct SoundSource {
  double x_m = 0, y_m = 0;
  std::complex<double> volume_m3;  // peak displacement times area
};

// The sound pressure p = -rho omega^2 / (2 pi) sum of volume exp(-i k R) / R, a peak value in Pa, to be
// multiplied by exp(+i omega t). The places must not be on the surface. Throws std::invalid_argument unless
// the frequency is above zero.
std::vector<std::complex<double>> radiated_pressure_Pa(std::span<const SoundSource> sources,
                                                       double frequency_Hz, std::span<const Place> places,
                                                       const Air& air = {});

// Divides the surface under one tone into sources, about six per wavelength in air. Across the strip it moves
// like the first transverse mode at its cut-off. Throws like evaluate_tones().
std::vector<SoundSource> sound_sources(const Surface& surface, const Tone& tone, Model model,
                                       const Air& air = {});

struct LoudestSound {
  double level_dB = 0;  // rms level relative to 20 uPa
  Place place;
};

// The loudest place among those in the plane y = 0 that are `distance_m` from the nearest point of the centre
// line. Outside that plane and farther away it is less loud, as long as the half-width is below
// sqrt(wavelength x distance), the width of the first Fresnel zone. The places are half a wavelength in air
// apart, at most 5 mm, which misses less than 0.3 dB. Throws std::invalid_argument if the distance is too
// short for this condition, or below a wavelength.
LoudestSound loudest_sound(const Surface& surface, const Tone& tone, Model model, double distance_m,
                           const Air& air = {});

}  // namespace turnpoint::physics

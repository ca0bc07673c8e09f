#pragma once
// Sound in air above a vibrating surface: Rayleigh's integral (Strutt 1878, Theory of Sound, section 278;
// Pierce, Acoustics, section 5-2) over the planned field. The clamp frame counts as an infinite rigid baffle
// and air as lossless, both of which make the sound louder than it is.
#include <complex>
#include <span>
#include <vector>

#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"

namespace turnpoint::physics {

struct Air {
  double density_kg_m3 = 1.204;  // 20 degrees C, 101.325 kPa, dry
  double speed_m_s = 343.2;
};

// From the centre of the drive edge: x along the strip, y across, z above the surface.
struct Place {
  double x_m = 0, y_m = 0, z_m = 0;
};

// A part of the surface, small against the wavelength in air, that moves up and down as a whole.
struct SoundSource {
  double x_m = 0, y_m = 0;
  std::complex<double> volume_m3;  // displacement (peak) times area
};

// p = -rho omega^2 / (2 pi) sum of volume exp(-i k R) / R, a peak value in Pa, for exp(+i omega t). The
// places must not touch the surface. Throws std::invalid_argument unless the frequency is above zero.
std::vector<std::complex<double>> radiated_pressure_Pa(std::span<const SoundSource> sources,
                                                       double frequency_Hz, std::span<const Place> places,
                                                       const Air& air = {});

// The surface under one tone as sources, about six in a wavelength in air. Across the strip
// it moves like the first transverse mode at its cut-off. Throws like evaluate_tones().
std::vector<SoundSource> sound_sources(const Surface& surface, const Tone& tone, Model model,
                                       const Air& air = {});

struct LoudestSound {
  double level_dB = 0;  // rms, re 20 uPa
  Place place;
};

// The loudest of all places in the plane y = 0 whose distance from the nearest point of the centre line is
// `distance_m`. Beside that plane and farther away it is less loud, as long as the half-width is below
// sqrt(wavelength x distance), the width of the first Fresnel zone. The places are a quarter of a wavelength
// in air apart, at most 5 mm, which misses less than 0.3 dB. Throws std::invalid_argument for a distance
// within that range or below a wavelength.
LoudestSound loudest_sound(const Surface& surface, const Tone& tone, Model model, double distance_m,
                           const Air& air = {});

}  // namespace turnpoint::physics

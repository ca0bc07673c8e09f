#pragma once
// Computes the sound in air above a vibrating surface. Evaluates Rayleigh's integral over the planned
// vibration (Strutt 1878, Theory of Sound, section 278; Pierce, Acoustics, section 5-2). The clamp frame is
// treated as an infinite rigid baffle and the air as lossless. Both simplifications make the computed sound
// louder than the real one.
#include <complex>
#include <optional>
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

// What the air on both faces does to a wave that runs over the surface, as over an infinite plane (Cremer &
// Heckl, Structure-Borne Sound; Fahy & Gardonio, Sound and Structural Vibration, ch. 3). Neither is part of
// the surface's equations: a stated or measured quality factor and tension have to include them.
struct AirLoad {
  // The quality factor that radiation alone would leave, omega rho h / (2 rho_air c / cos theta) with sin
  // theta = c k / omega. Empty if the wave is slower than sound, because it then radiates nothing.
  std::optional<double> quality_factor;
  // The mass of air that moves with the surface, 2 rho_air / sqrt(k^2 - (omega/c)^2), divided by the mass of
  // the surface. 0 if the wave is faster than sound.
  double mass_share = 0;
};
AirLoad air_load(const Surface& surface, double frequency_Hz, const Air& air = {});

// A place in the air. The origin is the centre of the drive edge; x runs along the strip, y across it, and z
// upwards from the surface.
struct Place {
  double x_m = 0, y_m = 0, z_m = 0;
};

// A part of the surface that moves up and down as a whole. It must be small compared with the wavelength in
// air.
struct SoundSource {
  double x_m = 0, y_m = 0;
  std::complex<double> volume_m3;  // peak displacement times area
};

// The sound pressure at each place, as a complex peak value in Pa: p = -rho omega^2 / (2 pi) sum of volume
// exp(-i k R) / R, with rho the density of air, k the wavenumber in air and R the distance from the source.
// The pressure at time t is the real part of p exp(+i omega t). The places must not be on the surface. Throws
// std::invalid_argument unless the frequency is above zero.
std::vector<std::complex<double>> radiated_pressure_Pa(std::span<const SoundSource> sources,
                                                       double frequency_Hz, std::span<const Place> places,
                                                       const Air& air = {});

// Divides the surface, which vibrates at one tone, into sources: at least eight per wavelength in air along
// the strip, and 24 across it. Across the strip, the displacement is assumed to have the shape of the first
// transverse mode at its cut-off. Throws like evaluate_tones().
std::vector<SoundSource> sound_sources(const Surface& surface, const Tone& tone, Model model,
                                       const Air& air = {});

struct LoudestSound {
  double level_dB = 0;  // rms sound level relative to 20 uPa
  Place place;
};

// Finds the loudest place in the plane y = 0 at `distance_m` from the centre line. Farther away, the sound is
// softer. Outside that plane it is softer too if the half-width is below sqrt(wavelength x distance), the
// width of the first Fresnel zone. The search tries places half a wavelength in air apart (or 5 mm, if that
// is less), so the result is less than 0.3 dB too low. Throws std::invalid_argument if the distance is below
// a wavelength, or if the half-width is not below the width of the Fresnel zone.
LoudestSound loudest_sound(const Surface& surface, const Tone& tone, Model model, double distance_m,
                           const Air& air = {});

}  // namespace turnpoint::physics

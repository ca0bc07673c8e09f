#pragma once
#include <optional>
#include <span>

#include "physics/model.hpp"
#include "physics/tone.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::scene {

/// An upper bound of the airborne ultrasound at the participant's ear. It is computed with Rayleigh's
/// integral, with the clamp frame as an infinite baffle and without absorption, for the loudest place at the
/// ear's distance (physics/airborne.hpp). Of all third-octave bands, this is the band that exceeds its limit
/// most or comes nearest to it.
struct SoundBound {
  double level_dB = 0;      ///< rms level of all tones in the band, re 20 uPa
  double allowed_dB = 0;    ///< limit of the band, see terms::allowed_sound_dB()
  double frequency_Hz = 0;  ///< frequency of the loudest tone in the band
};

/// Computes the bound for tones with amplitudes at the drive edge. Empty if there is no tone, or if the
/// surface is too wide for the bound to hold (see physics::loudest_sound()).
std::optional<SoundBound> sound_bound(const rig::Rig& rig, std::span<const physics::Tone> tones,
                                      physics::Model model);

/// The smallest distance that the bound assumes between the participant's ear and the surface.
inline constexpr double kEarDistance_m = 0.4;

}  // namespace turnpoint::scene

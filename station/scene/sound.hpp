#pragma once
#include <optional>
#include <span>

#include "physics/model.hpp"
#include "physics/tone.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::scene {

/// An upper bound of the airborne ultrasound at the participant's ear, for the third-octave band that exceeds
/// its limit most or comes nearest to it. It is computed with Rayleigh's integral for the loudest place at
/// the ear's distance, with the clamp frame as an infinite baffle and without absorption
/// (physics/airborne.hpp).
struct SoundBound {
  double level_dB = 0;      ///< rms level of all tones in the band, re 20 uPa
  double allowed_dB = 0;    ///< highest level allowed in the band, see terms::allowed_sound_dB()
  double frequency_Hz = 0;  ///< frequency of the loudest tone in the band
};

/// Computes this upper bound for tones whose amplitudes are given at the drive edge. Empty if there is no
/// tone, or if the surface is too wide for the bound to hold (see physics::loudest_sound()).
std::optional<SoundBound> sound_bound(const rig::Rig& rig, std::span<const physics::Tone> tones,
                                      physics::Model model);

/// Distance from the surface at which sound_bound() computes the level. The participant's ear must not be
/// closer to the surface.
inline constexpr double kEarDistance_m = 0.4;

}  // namespace turnpoint::scene

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
  double allowed_dB = 0;    ///< limit of the band, see terms::allowed_sound_dB()
  double frequency_Hz = 0;  ///< frequency of the loudest tone in the band
};

/// Computes the bound for tones with amplitudes at the drive edge. Empty if there is no tone, or if the
/// surface is too wide for the bound to hold (see physics::loudest_sound()).
std::optional<SoundBound> sound_bound(const rig::Rig& rig, std::span<const physics::Tone> tones,
                                      physics::Model model);

/// The distance between the participant's ear and the surface for which the bound is computed. The ear must
/// not be closer.
inline constexpr double kEarDistance_m = 0.4;

}  // namespace turnpoint::scene

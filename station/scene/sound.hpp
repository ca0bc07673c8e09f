#pragma once
#include <optional>
#include <span>

#include "physics/model.hpp"
#include "physics/tone.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::scene {

/// An upper bound of the airborne ultrasound at the participant's ear: Rayleigh's integral with the clamp
/// frame as an infinite baffle, no absorption, and the loudest place at that distance (physics/airborne.hpp).
/// Of all third-octave bands, the one that exceeds its limit most, or comes nearest to it.
struct SoundBound {
  double level_dB = 0;      ///< rms over the tones in the band, re 20 uPa
  double allowed_dB = 0;    ///< see terms::allowed_sound_dB()
  double frequency_Hz = 0;  ///< the loudest tone in the band
};

/// Tones as at the drive edge. Empty if there is no tone, or if the bound does not hold for this surface
/// because it is too wide (see physics::loudest_sound()).
std::optional<SoundBound> sound_bound(const rig::Rig& rig, std::span<const physics::Tone> tones,
                                      physics::Model model);

/// Smallest distance between the participant's ear and the surface.
inline constexpr double kEarDistance_m = 0.4;

}  // namespace turnpoint::scene

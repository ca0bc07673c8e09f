#pragma once
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <utility>

#include "physics/model.hpp"
#include "physics/surface.hpp"
#include "physics/tone.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::scene {

/// An upper bound of the airborne ultrasound at the participant's ear, for the third-octave band that exceeds
/// its limit most or comes nearest to it. It is computed with Rayleigh's integral for the loudest place at
/// the ear's distance, with the clamp frame as an infinite baffle and without absorption
/// (physics/airborne.hpp).
struct SoundBound {
  double level_dB = 0;      ///< rms level of all tones in the band, re 20 uPa
  double allowed_dB = 0;    ///< highest level allowed in the band, see core::allowed_sound_dB()
  double frequency_Hz = 0;  ///< frequency of the loudest tone in the band
};

/// Computes this upper bound for tones whose amplitudes are given at the drive edge. Empty if there is no
/// tone, or if the surface is too wide for the bound to hold (see physics::loudest_sound()).
std::optional<SoundBound> sound_bound(const rig::Rig& rig, std::span<const physics::Tone> tones,
                                      physics::Model model);

/// sound_bound() for many sets of tones on one rig. The level of a tone is proportional to its amplitude, so
/// the level of each frequency is computed once for each model. Several threads may call it.
class ToneLevels {
 public:
  explicit ToneLevels(const rig::Rig& rig);
  std::optional<SoundBound> bound(std::span<const physics::Tone> tones, physics::Model model);

 private:
  double level_dB(const physics::Tone& tone, physics::Model model);

  physics::Surface surface_;
  std::mutex mutex_;
  /// level of a displacement of one metre of the drive edge, by frequency (Hz) and model
  std::map<std::pair<double, physics::Model>, double> known_;
};

/// Distance from the surface at which sound_bound() computes the level. The participant's ear must not be
/// closer to the surface.
inline constexpr double kEarDistance_m = 0.4;

}  // namespace turnpoint::scene

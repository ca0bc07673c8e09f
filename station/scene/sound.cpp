#include "station/scene/sound.hpp"

#include <cmath>
#include <map>
#include <stdexcept>

#include "physics/airborne.hpp"
#include "station/scene/planner.hpp"
#include "station/terms/limits.hpp"

namespace turnpoint::scene {

std::optional<SoundBound> sound_bound(const rig::Rig& rig, std::span<const physics::Tone> tones,
                                      physics::Model model) {
  struct Band {
    double power = 0, loudest_dB = -1e300, frequency_Hz = 0;
  };
  std::map<long, Band> bands;
  const auto surface = surface_of(rig);
  // As for the rig's limits, a model coarser than `mode` is not good enough for the field.
  const auto with_field = model == physics::Model::modes ? model : physics::Model::mode;
  for (const auto& tone : tones) {
    if (!(tone.amplitude_m > 0)) continue;
    double level_dB = 0;
    try {
      level_dB = physics::loudest_sound(surface, tone, with_field, kEarDistance_m).level_dB;
    } catch (const std::invalid_argument&) {
      return std::nullopt;
    }
    auto& band = bands[std::lround(10 * std::log10(1e-3 * tone.frequency_Hz))];
    // Each tone is loudest at a different place, so the sum of the maxima is an upper bound.
    band.power += std::pow(10, 0.1 * level_dB);
    if (level_dB > band.loudest_dB) band.loudest_dB = level_dB, band.frequency_Hz = tone.frequency_Hz;
  }
  std::optional<SoundBound> worst;
  for (const auto& [number, band] : bands) {
    const SoundBound bound{10 * std::log10(band.power), terms::allowed_sound_dB(band.frequency_Hz),
                           band.frequency_Hz};
    if (!worst || bound.level_dB - bound.allowed_dB > worst->level_dB - worst->allowed_dB) worst = bound;
  }
  return worst;
}

}  // namespace turnpoint::scene

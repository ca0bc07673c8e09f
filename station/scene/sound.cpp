#include "station/scene/sound.hpp"

#include <cmath>
#include <map>
#include <stdexcept>

#include "physics/airborne.hpp"
#include "station/core/limits.hpp"
#include "station/scene/planner.hpp"

namespace turnpoint::scene {

std::optional<SoundBound> sound_bound(const rig::Rig& rig, std::span<const physics::Tone> tones,
                                      physics::Model model) {
  return ToneLevels(rig).bound(tones, model);
}

ToneLevels::ToneLevels(const rig::Rig& rig) : surface_(surface_of(rig)) {}

double ToneLevels::level_dB(const physics::Tone& tone, physics::Model model) {
  const std::pair key(tone.frequency_Hz, model);
  const double more_dB = 20 * std::log10(tone.amplitude_m);
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = known_.find(key); found != known_.end()) return found->second + more_dB;
  }
  const double level_dB = physics::loudest_sound(surface_, tone, model, kEarDistance_m).level_dB;
  const std::lock_guard lock(mutex_);
  known_.emplace(key, level_dB - more_dB);
  return level_dB;
}

std::optional<SoundBound> ToneLevels::bound(std::span<const physics::Tone> tones, physics::Model model) {
  struct Band {
    double power = 0, loudest_dB = -1e300, frequency_Hz = 0;
  };
  std::map<long, Band> bands;
  // As for the rig's limits, a model coarser than `mode` is not good enough for the field.
  const auto with_field = model == physics::Model::modes ? model : physics::Model::mode;
  for (const auto& tone : tones) {
    if (!(tone.amplitude_m > 0)) continue;
    double level = 0;
    try {
      level = level_dB(tone, with_field);
    } catch (const std::invalid_argument&) {
      return std::nullopt;
    }
    auto& band = bands[std::lround(10 * std::log10(1e-3 * tone.frequency_Hz))];
    // Each tone is loudest at a different place, so the sum of the maxima is an upper bound.
    band.power += std::pow(10, 0.1 * level);
    if (level > band.loudest_dB) band.loudest_dB = level, band.frequency_Hz = tone.frequency_Hz;
  }
  std::optional<SoundBound> worst;
  for (const auto& [number, band] : bands) {
    const SoundBound bound{10 * std::log10(band.power), core::allowed_sound_dB(band.frequency_Hz),
                           band.frequency_Hz};
    if (!worst || bound.level_dB - bound.allowed_dB > worst->level_dB - worst->allowed_dB) worst = bound;
  }
  return worst;
}

}  // namespace turnpoint::scene

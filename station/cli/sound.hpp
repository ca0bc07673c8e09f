#pragma once
#include <fmt/format.h>

#include <optional>
#include <string>

#include "station/cli/json.hpp"
#include "station/core/number.hpp"
#include "station/scene/sound.hpp"

namespace turnpoint::cli {

/// The upper limit of the airborne sound level, as text for one line.
inline std::string in_words(const std::optional<scene::SoundBound>& sound) {
  if (!sound)
    return "no upper limit of the level is known for this surface; a live session needs measured levels";
  return fmt::format("at most {} dB at an ear {} m away ({} kHz); recommended: at most {} dB{}",
                     core::number(sound->level_dB, 4), core::number(scene::kEarDistance_m),
                     core::number(1e-3 * sound->frequency_Hz, 4), core::number(sound->allowed_dB),
                     sound->level_dB > sound->allowed_dB ? "; a live session needs measured levels" : "");
}

inline Json json_sound(const std::optional<scene::SoundBound>& sound) {
  if (!sound) return nullptr;
  return {{"bound_dB", json_number(sound->level_dB)},
          {"allowed_dB", json_number(sound->allowed_dB)},
          {"frequency_Hz", json_number(sound->frequency_Hz)},
          {"ear_distance_m", scene::kEarDistance_m}};
}

/// Formats the uncertainty of a boundary (one standard deviation) for a line of text.
inline std::string uncertainty_in_words(double uncertainty_m) {
  if (!(uncertainty_m > 0)) return "uncertainty not known: the rig file states no standard deviations";
  return "uncertain by " + core::number(1e3 * uncertainty_m, 3) +
         " mm (SD) because of the rig's parameters; see `turnpoint map --budget`";
}

}  // namespace turnpoint::cli

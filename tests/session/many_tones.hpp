// A protocol whose two intervals take different times to prepare, because one has one tone and the other
// twenty. With masking noise, the bound on the peak is above full scale. The station must therefore render
// each burst to find its real peak.
#pragma once
#include <fstream>
#include <iterator>
#include <string>

#include "station/audio/prepared_burst.hpp"

namespace turnpoint::many_tones {

inline constexpr int kTones = 20;
inline constexpr double kDuration_s = 0.4, kGap_s = 0.3;

inline std::string protocol_text() {
  std::string text = R"(format = "friction-protocol/1"
[protocol]
id = "many-tones"
version = "1.0.0"
title = "One tone or twenty"
languages = ["en"]
[random]
seed = 7
[[factor]]
name = "step_Hz"
range = [500.0, 700.0]
[scene.one]
tones = [{ frequency_Hz = 30000, displacement_um = 0.3 }]
[scene.many]
tones = [
)";
  for (int k = 0; k < kTones; ++k)
    text += "{ frequency_Hz = \"24000 + " + std::to_string(k) + " * step_Hz\", displacement_um = 0.3 },\n";
  return text + R"(]
[task]
kind = "2ifc"
intervals = ["one", "many"]
duration_s = 0.4
gap_s = 0.3
sound = "masking_noise"
device = "touch"
question = { en = "In which interval were there more tones?" }
choices = [{ id = "first", label = { en = "First" } }, { id = "second", label = { en = "Second" } }]
correct = "many"
[timing]
response_zero = "interval_off"
deadline_s = 3.0
iti_s = 0.2
anticipation_s = 0.0
[[procedure]]
name = "steps"
kind = "constant-stimuli"
level = "step_Hz"
values = [510.0, 613.0]
repeats = 2
[[block]]
name = "main"
procedures = ["steps"]
)";
}

inline std::string rig_text() {
  std::ifstream file(std::string(TURNPOINT_SOURCE_DIR) + "/tests/support/thin_plate.toml");
  return std::string(std::istreambuf_iterator<char>(file), {}) + "\n[noise]\nchannel = 2\nrms = 0.15\n";
}

/// Returns true if the burst was accepted only because its peak was rendered: the bound on its peak is above
/// full scale.
inline bool peak_was_rendered(const audio::PreparedBurst& burst) {
  const auto limit = audio::SynthLimits{}.peak;
  return audio::peak_bound(burst)[2] > limit && burst.peak[2] <= limit;
}

}  // namespace turnpoint::many_tones

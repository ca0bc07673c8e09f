#include "station/session/mixer.hpp"

#include "station/drive/alsa_mixer.hpp"

namespace turnpoint::session {

using texts::phrase, texts::plain;

std::map<std::string, std::string> mixer_levels(const rig::Rig& rig) {
  auto levels = drive::mixer_levels(rig.output.uri).value_or(std::map<std::string, std::string>{});
  if (!rig.capture || rig.capture->uri == rig.output.uri) return levels;
  const auto captured = drive::mixer_levels(rig.capture->uri);
  if (captured && *captured != levels)
    for (const auto& [control, values] : *captured) levels["capture: " + control] = values;
  return levels;
}

MixerReading read_mixer(const rig::Rig& rig) {
  MixerReading reading{rig.mixer.size(), {}};
  if (rig.mixer.empty()) return reading;
  const auto now = mixer_levels(rig);
  for (const auto& [control, values] : rig.mixer) {
    const auto found = now.find(control);
    if (found == now.end())
      reading.changes.push_back(phrase("self_test.mixer_gone", {plain(control), plain(values)}));
    else if (found->second != values)
      reading.changes.push_back(
          phrase("self_test.mixer_changed", {plain(control), plain(found->second), plain(values)}));
  }
  return reading;
}

}  // namespace turnpoint::session

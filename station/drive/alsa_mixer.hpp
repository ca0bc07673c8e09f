#pragma once
#include <map>
#include <optional>
#include <string>

namespace turnpoint::drive {

/// Reads a switch of the sound card behind an output `alsa:...`, such as "Auto Mute Switch" of a PCM512x.
/// Returns true if it is on in any channel. Returns nothing if the output is not ALSA hardware, the card has
/// no such switch, or it cannot be read. Changes nothing.
std::optional<bool> card_switch(const std::string& output_uri, const std::string& name);

/// Reads the mixer of the sound card behind a device `alsa:...`: each level, switch and choice that somebody
/// can set, by its name (with its index if there are several of that name), as the values of its channels:
/// "207, 207", "on", "Line 1". Leaves out what the card changes by itself. Returns nothing if the device is
/// not on a card, or the card cannot be read. Changes nothing.
std::optional<std::map<std::string, std::string>> mixer_levels(const std::string& device_uri);

}  // namespace turnpoint::drive

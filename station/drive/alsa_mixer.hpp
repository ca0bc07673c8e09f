#pragma once
#include <optional>
#include <string>

namespace turnpoint::drive {

/// Reads a switch of the sound card behind an output `alsa:hw:...`, such as "Auto Mute Switch" of a PCM512x.
/// Returns true if it is on in any channel. Returns nothing if the output is not ALSA hardware, the card has
/// no such switch, or it cannot be read. Changes nothing.
std::optional<bool> card_switch(const std::string& output_uri, const std::string& name);

}  // namespace turnpoint::drive

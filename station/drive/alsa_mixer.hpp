#pragma once
#include <optional>
#include <string>

namespace turnpoint::drive {

/// Whether a switch of the sound card behind an output `alsa:hw:...` is on, such as "Auto Mute Switch" of a
/// PCM512x: on in any channel counts. None where the output is no hardware of ALSA, the card has no such
/// switch, or it cannot be asked. Changes nothing.
std::optional<bool> card_switch(const std::string& output_uri, const std::string& name);

}  // namespace turnpoint::drive

#pragma once
#include <string>
#include <vector>

#include "station/drive/engine.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// Plays bursts on a converter (`alsa:NAME`) with the rig's amplifier, in real time and without a session.
/// The start frames of the bursts count from a moment soon after the amplifier is on. Calling this function
/// arms the amplifier, so only an operator may request it. The amplifier is on from before the first burst
/// until after the last. A stop signal (see StopSignals) ramps down the tones that are playing and then
/// switches the amplifier off.
///
/// Throws the errors of drive::open_realtime and lines::open_amplifier. Throws std::runtime_error if the
/// amplifier cannot be armed, after a fault, for lost frames, or after a stop signal.
drive::PlayReport play_armed(const rig::Rig& rig, const std::string& uri,
                             const std::vector<drive::Burst>& bursts);

}  // namespace turnpoint::maintenance

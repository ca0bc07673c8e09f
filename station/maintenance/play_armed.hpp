#pragma once
#include <string>
#include <vector>

#include "station/drive/engine.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// Plays bursts on a converter (`alsa:NAME`) and the rig's amplifier, in real time, without a session. Their
/// start frames count from one moment, soon after the amplifier is on. To call it is the operator's arming:
/// the amplifier is on from before the first burst until after the last. A stop signal (see StopSignals)
/// ramps down what sounds and then turns the amplifier off. Throws as drive::open_realtime and
/// lines::open_amplifier; std::runtime_error for an amplifier that cannot be armed, a fault on the way,
/// frames that were lost, or a stop signal.
drive::PlayReport play_armed(const rig::Rig& rig, const std::string& uri,
                             const std::vector<drive::Burst>& bursts);

}  // namespace turnpoint::maintenance

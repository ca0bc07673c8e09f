#pragma once
#include <string>
#include <vector>

#include "station/drive/engine.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// Plays bursts on a converter (`alsa:NAME`) with the rig's amplifier, in real time and without a session.
/// Their start frames are relative to one moment, soon after the amplifier is on. By calling this the
/// operator arms the amplifier: it is on from before the first burst until after the last. A stop signal (see
/// StopSignals) ramps down what is sounding, then switches the amplifier off. Throws the errors of
/// drive::open_realtime and lines::open_amplifier, and std::runtime_error if the amplifier cannot be armed,
/// after a fault, for lost frames, or after a stop signal.
drive::PlayReport play_armed(const rig::Rig& rig, const std::string& uri,
                             const std::vector<drive::Burst>& bursts);

}  // namespace turnpoint::maintenance

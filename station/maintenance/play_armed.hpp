#pragma once
#include <stop_token>
#include <string>
#include <vector>

#include "station/audio/engine.hpp"
#include "station/protocol/protocol.hpp"
#include "station/rig/rig.hpp"

namespace turnpoint::maintenance {

/// Plays bursts on a converter (`alsa:NAME`) with the rig's amplifier, in real time and without a session.
/// The start frames of the bursts count from a moment soon after the amplifier is on. Calling this function
/// arms the amplifier, so only an operator may request it. The amplifier is on from before the first burst
/// until after the last. A stop signal (see StopSignals) ramps down the tones that are playing and then
/// switches the amplifier off.
///
/// Throws the errors of audio::open_realtime and io::open_amplifier. Throws core::Failure if the
/// amplifier cannot be armed, after a fault, for lost frames, or after a stop signal.
audio::PlayReport play_armed(const rig::Rig& rig, const std::string& uri,
                             const std::vector<audio::Burst>& bursts);

/// Like the function above, for a program that handles stop signals itself. After a request to stop, the
/// tones are ramped down, the amplifier is switched off, and the function returns normally.
audio::PlayReport play_armed(const rig::Rig& rig, const std::string& uri,
                             const std::vector<audio::Burst>& bursts, const std::stop_token& stop);

/// True if the rig's output drives a surface that can be felt; false if it is simulated.
bool can_be_felt(const rig::Rig& rig);

/// Plays one burst on the rig at an operator's request: with play_armed() on a rig that can be felt;
/// otherwise the sound is only computed. Throws the errors of play_armed(), and audio::BurstRefused.
audio::PlayReport play_on_rig(const rig::Rig& rig, const audio::Burst& burst, const std::stop_token& stop);

/// What was played when somebody tried out a scene.
struct FeltScene {
  double length_s = 0;
  double rest_s = 0;  ///< how long the surface must then be still, by the rig's limits
  int tones = 0;
  double peak = 0;  ///< largest sample relative to full scale
};

/// Plays a scene of a protocol once, for as long as an interval of the task lasts, but for at most 5 s and
/// within the rig's limits. See play_on_rig(). `stop` ends it at once. Throws scene::Unreachable,
/// audio::BurstRefused, and the errors of play_armed().
FeltScene feel_scene(const rig::Rig& rig, const protocol::Protocol& protocol, const std::string& scene,
                     const protocol::Factors& factors, const std::stop_token& stop);

}  // namespace turnpoint::maintenance
